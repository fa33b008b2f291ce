//! Certain misses in `f32`, in lanes.
//!
//! **The bound.** Let ε = 2^-24, D the largest component of the direction (its span), L of the edges from the
//! first corner, and S the sum of the components of the origin relative to that corner, all absolute. Differences of coordinates and
//! all operations are exact up to a factor 1 + δ, |δ| ≤ ε, and an underflow of at most 2^-150 a product.
//!
//! - Scaled u and v are sums of six products of a component each of the direction, an edge and
//!   the relative origin: at most 2DLS in all, each with at most 7 factors. Off by 14ε·DLS.
//! - The determinant likewise: at most 6DL², off by 42ε·DL².
//! - w = det − u − v adds their errors and two roundings: 34ε·DLS + 54ε·DL².
//! - Scaled t is a sum of at most 2L²S with 8 factors each: off by 16ε·L²S.
//!
//! All are below 64ε·DL(S + L) and 64ε·L²(S + L), the margin covering second-order terms, the rounding of the
//! bounds themselves and that of the comparisons of t. With 2^-30 ≤ D ≤ 2^30 and S + L < 2^45 nothing overflows, and underflows
//! add less than [`TINY`] to each. Beyond those sizes nothing is rejected here.

use crate::kernel::{Corners, cross3, dot3, splat_row3, store_rows, sub3};
use crate::packet::{Common, Packet, Vec3Lanes, splat3};
use crate::simd::{Row, Scalar, Simd};

const BOUND: f32 = 64.0 * f32::EPSILON / 2.0;

/// 2^-100
const TINY: f32 = 7.888_609e-31;

/// 2^45
const GREAT: f32 = 35_184_372_088_832.0;

/// 2^-30 and 2^30
const SPANS: [f32; 2] = [9.313_226e-10, 1_073_741_824.0];

/// The size of a direction.
#[derive(Clone, Copy)]
pub struct Span<S: Simd> {
    /// Its largest component.
    largest: S::F,
    /// 0, or infinity where the bound is not for such a size.
    beyond: S::F,
}

impl<S: Simd> Span<S> {
    #[inline(always)]
    pub(super) fn of(s: S, direction: Vec3Lanes<S>) -> Self {
        let largest = largest3(s, direction);
        let fits = s.and(s.le(s.splat(SPANS[0]), largest), s.le(largest, s.splat(SPANS[1])));
        Self { largest, beyond: s.select(fits, s.splat(0.0), s.splat(f32::INFINITY)) }
    }
}

impl Span<Scalar> {
    /// The same in all lanes.
    #[inline(always)]
    pub(super) fn splat<S: Simd>(&self, s: S) -> Span<S> {
        Span { largest: s.splat(self.largest), beyond: s.splat(self.beyond) }
    }
}

#[inline(always)]
fn largest3<S: Simd>(s: S, v: Vec3Lanes<S>) -> S::F {
    s.max(s.max(s.abs(v[0]), s.abs(v[1])), s.abs(v[2]))
}

/// What the test of a lane is made of.
#[derive(Clone, Copy)]
struct Parts<S: Simd> {
    edge2: Vec3Lanes<S>,
    from_a: Vec3Lanes<S>,
    /// Direction × second edge.
    p: Vec3Lanes<S>,
    /// Relative origin × first edge.
    q: Vec3Lanes<S>,
    det: S::F,
    /// Largest component of the edges: L.
    length: S::F,
    /// Sum of the components of the relative origin: S.
    distance: S::F,
}

/// The largest component of the edges from the first corner: L.
#[inline(always)]
pub(super) fn length_of([a, b, c]: &Corners) -> f32 {
    let (edge1, edge2) = (*b - *a, *c - *a);
    length(Scalar, edge1.to_array(), edge2.to_array())
}

/// The lanes that may be hit at t up to `t_max`, as bits. NaN, as in empty lanes, is not. `length` is that of [`length_of`].
#[inline(always)]
pub(super) fn open<S: Simd>(
    s: S,
    ray: &Packet<S>,
    span: &Span<S>,
    [a, b, c]: [Vec3Lanes<S>; 3],
    length: S::F,
    t_max: S::F,
) -> u32 {
    let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
    let from_a = sub3(s, ray.origin, a);
    let p = cross3(s, ray.direction, edge2);
    let parts = Parts {
        edge2,
        from_a,
        p,
        q: cross3(s, from_a, edge1),
        det: dot3(s, edge1, p),
        length,
        distance: distance(s, from_a),
    };
    undecided(s, ray, span, &parts, t_max)
}

/// Rows that [`prepare`] writes.
pub(super) const PREPARED_ROWS: usize = 15;

/// Writes the parts that are the same for all rays with this in common: in rows 0–5 the edges, in
/// row 13 their length, and from row 6 on p and the determinant or the relative origin, q and the distance.
#[inline(always)]
pub(super) fn prepare<S: Simd>(
    s: S,
    common: &Common,
    [a, b, c]: [Vec3Lanes<S>; 3],
    rows: &mut [Row],
    at: usize,
) {
    let rows = &mut rows[..PREPARED_ROWS];
    let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
    store_rows(s, edge1, &mut rows[0..3], at);
    store_rows(s, edge2, &mut rows[3..6], at);
    s.store(length(s, edge1, edge2), &mut rows[13].0[at..]);
    match common {
        Common::Direction(direction) => {
            let p = cross3(s, splat3(s, *direction), edge2);
            store_rows(s, p, &mut rows[6..9], at);
            s.store(dot3(s, edge1, p), &mut rows[12].0[at..]);
        }
        Common::Origin(origin) => {
            let from_a = sub3(s, splat3(s, *origin), a);
            store_rows(s, from_a, &mut rows[6..9], at);
            store_rows(s, cross3(s, from_a, edge1), &mut rows[9..12], at);
            s.store(distance(s, from_a), &mut rows[14].0[at..]);
        }
    }
}

/// The triangle in a lane of a group, prepared.
#[derive(Clone, Copy)]
pub(super) struct Prepared<'a> {
    pub common: &'a Common,
    pub group: &'a [Row],
    pub rows: &'a [Row],
    pub lane: usize,
}

/// [`open`] for a triangle prepared.
#[inline(always)]
pub(super) fn open_prepared<S: Simd>(
    s: S,
    ray: &Packet<S>,
    span: &Span<S>,
    triangle: Prepared<'_>,
    t_max: S::F,
) -> u32 {
    let Prepared { common, group, rows, lane } = triangle;
    let rows = &rows[..PREPARED_ROWS];
    let edge1 = splat_row3(s, &rows[0..3], lane);
    let edge2 = splat_row3(s, &rows[3..6], lane);
    let length = s.splat(rows[13].0[lane]);
    let parts = match common {
        Common::Direction(_) => {
            let from_a = sub3(s, ray.origin, splat_row3(s, &group[0..3], lane));
            Parts {
                edge2,
                from_a,
                p: splat_row3(s, &rows[6..9], lane),
                q: cross3(s, from_a, edge1),
                det: s.splat(rows[12].0[lane]),
                length,
                distance: distance(s, from_a),
            }
        }
        Common::Origin(_) => {
            let p = cross3(s, ray.direction, edge2);
            Parts {
                edge2,
                from_a: splat_row3(s, &rows[6..9], lane),
                p,
                q: splat_row3(s, &rows[9..12], lane),
                det: dot3(s, edge1, p),
                length,
                distance: s.splat(rows[14].0[lane]),
            }
        }
    };
    undecided(s, ray, span, &parts, t_max)
}

#[inline(always)]
fn length<S: Simd>(s: S, edge1: Vec3Lanes<S>, edge2: Vec3Lanes<S>) -> S::F {
    s.max(largest3(s, edge1), largest3(s, edge2))
}

#[inline(always)]
fn distance<S: Simd>(s: S, from_a: Vec3Lanes<S>) -> S::F {
    s.add(s.add(s.abs(from_a[0]), s.abs(from_a[1])), s.abs(from_a[2]))
}

#[inline(always)]
fn undecided<S: Simd>(s: S, ray: &Packet<S>, span: &Span<S>, parts: &Parts<S>, t_max: S::F) -> u32 {
    let Parts { edge2, from_a, p, q, det, length, distance } = *parts;
    let u = dot3(s, from_a, p);
    let v = dot3(s, ray.direction, q);
    let w = s.sub(s.sub(det, u), v);
    let size = s.add(distance, length);
    let area = s.mul(s.mul(length, s.splat(BOUND)), size);
    let error = s.add(s.mul(area, span.largest), s.splat(TINY));

    let zero = s.splat(0.0);
    let least = s.min(s.min(u, v), w);
    let greatest = s.max(s.max(u, v), w);
    // Of one sign, or not certainly of different ones.
    let inside = s.or(s.le(s.sub(zero, error), least), s.le(greatest, error));
    let unbounded = s.le(s.splat(GREAT), s.add(size, span.beyond));
    let open = s.bits(s.or(inside, unbounded));
    if open == 0 {
        return 0;
    }

    // Few tests come here.
    let scaled_t = dot3(s, edge2, q);
    let t_error = s.add(s.mul(area, length), s.splat(TINY));
    let size_of_det = s.abs(det);
    let minus_t = s.sub(zero, scaled_t);
    let negative = s.lt(det, zero);
    let signed_t = s.select(negative, minus_t, scaled_t);
    let past = s.lt(times(s, t_max, size_of_det, error), s.sub(signed_t, t_error));
    let minus_t = s.select(negative, scaled_t, minus_t);
    let before = s.lt(times(s, s.sub(zero, ray.t_min), size_of_det, error), s.sub(minus_t, t_error));
    let out_of_range = s.and(s.or(past, before), s.lt(error, size_of_det));
    open & (!s.bits(out_of_range) | s.bits(unbounded))
}

/// The most that limit·det can be.
#[inline(always)]
fn times<S: Simd>(s: S, limit: S::F, size_of_det: S::F, error: S::F) -> S::F {
    s.add(s.mul(limit, size_of_det), s.mul(s.abs(limit), error))
}
