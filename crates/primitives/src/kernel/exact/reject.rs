//! What `f32` can tell for certain, in lanes: misses, hits, and bounds of t.
//!
//! **The bound.** Let ε = 2^-24, D the largest component of the direction (its span), L of the edges from the
//! first corner, and S the sum of the components of the origin relative to that corner, all absolute. Differences of coordinates and
//! all operations are exact up to a factor 1 + δ, |δ| ≤ ε, and an underflow of at most 2^-150 a product. Where a product and a sum are
//! rounded as one, that is a factor less.
//!
//! - Scaled u and v are sums of six products of a component each of the direction, an edge and
//!   the relative origin: at most 2DLS in all, each with at most 7 factors. Off by 14ε·DLS.
//! - The determinant likewise: at most 6DL², off by 42ε·DL².
//! - w = det − u − v adds their errors and two roundings: 34ε·DLS + 54ε·DL².
//! - Scaled t is a sum of six products of a component each of both edges and the relative origin, each with at most 8 factors: off
//!   by 8ε of the sum V of their sizes.
//!
//! With U = 18ε·L(S + 1.5L), u and v are off by less than DU, w by less than 2.5DU, the determinant by less than 48ε·DL²,
//! however far away the ray begins, and scaled t by less than 10ε·V, the margin of an eighth or more covering second-order terms, the rounding of the bounds themselves and that of the
//! comparisons. With 2^-30 ≤ D ≤ 2^30 and coordinates up to 2^41 nothing overflows, and underflows
//! add less than [`TINY`] to each. Beyond those sizes D or L counts as infinite, and nothing is certain.
//!
//! **t itself.** Let T and d be scaled t and the determinant as computed, T + τ and d + δ the true ones, and q the quotient
//! T/d as computed, off by 3ε|q| or by the least normal float. The true t is off T/d by (τ − δT/d)/(d + δ), at most
//! (|τ| + |T/d|·|δ|)/|d| · 16/15 where |δ| < |d|/16. The bounds of t add that, with a margin for its own rounding and that of q.

use super::LENGTH_ROW;
use crate::kernel::packed::splat_row3;
use crate::kernel::{Packed, Prepared, size3, store_rows, sub3};
use accel::{Common, Corners};
use lanes::packet::{Bounds, Packet, Vec3Lanes, splat3};
use lanes::{Row, Scalar, Simd};

/// 18ε
const BOUND: f32 = 18.0 * f32::EPSILON / 2.0;

/// 10ε
const T_BOUND: f32 = 10.0 * f32::EPSILON / 2.0;

/// 48ε
const DET_BOUND: f32 = 48.0 * f32::EPSILON / 2.0;

/// How much less certain than u and v w is; a power of two would be too much.
const OF_W: f32 = 2.5;

/// 2^-100
const TINY: f32 = 7.888_609e-31;

/// The bounds of t are for determinants of more than so many errors.
const FIRM: f32 = 16.0;

/// Above 16/15, and what rounding the bounds of t themselves adds.
const MARGIN: f32 = 1.125;

/// 16ε
const ROUNDING: f32 = 16.0 * f32::EPSILON / 2.0;

/// 2^41
const GREAT: f32 = 2_199_023_255_552.0;

/// 2^-30 and 2^30
const SPANS: [f32; 2] = [9.313_226e-10, 1_073_741_824.0];

/// The size of a direction.
#[derive(Clone, Copy)]
pub struct Span<S: Simd> {
    /// The largest component of the direction: D, or infinity where the bound is not for such rays.
    largest: S::F,
}

impl<S: Simd> Span<S> {
    #[inline(always)]
    pub(super) fn of(s: S, origin: Vec3Lanes<S>, direction: Vec3Lanes<S>) -> Self {
        let largest = largest3(s, direction);
        let fits = s.and(s.le(s.splat(SPANS[0]), largest), s.le(largest, s.splat(SPANS[1])));
        let fits = s.and(fits, s.le(largest3(s, origin), s.splat(GREAT)));
        Self { largest: s.select(fits, largest, s.splat(f32::INFINITY)) }
    }
}

impl<S: Simd> Span<S> {
    /// Those of the lanes whose numbers `at` holds.
    #[inline(always)]
    pub(super) fn permuted(&self, s: S, at: S::U) -> Self {
        Self { largest: s.permute(self.largest, at) }
    }
}

impl Span<Scalar> {
    /// The same in all lanes.
    #[inline(always)]
    pub(super) fn splat<S: Simd>(&self, s: S) -> Span<S> {
        Span { largest: s.splat(self.largest) }
    }
}

#[inline(always)]
fn largest3<S: Simd>(s: S, v: Vec3Lanes<S>) -> S::F {
    s.max(s.max(s.abs(v[0]), s.abs(v[1])), s.abs(v[2]))
}

/// What the test of a lane is made of.
#[derive(Clone, Copy)]
struct Parts<S: Simd> {
    edge1: Vec3Lanes<S>,
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

/// The largest component of the edges from the first corner: L, or infinity where the bound is not for such corners.
#[inline(always)]
pub(super) fn length_of([a, b, c]: &Corners) -> f32 {
    let largest = a.abs().max(b.abs()).max(c.abs()).max_element();
    if largest > GREAT {
        return f32::INFINITY;
    }
    let (edge1, edge2) = (*b - *a, *c - *a);
    edge1.abs().max(edge2.abs()).max_element()
}

/// [`length_of`] in lanes.
#[inline(always)]
pub(super) fn lengths<S: Simd>(s: S, [a, b, c]: [Vec3Lanes<S>; 3]) -> S::F {
    let largest = s.max(s.max(largest3(s, a), largest3(s, b)), largest3(s, c));
    let edges = s.max(largest3(s, sub3(s, b, a)), largest3(s, sub3(s, c, a)));
    s.select(s.le(largest, s.splat(GREAT)), edges, s.splat(f32::INFINITY))
}

/// What `f32` can tell of hits at t up to `t_max`, of the lanes `wanted`. `length` is that of [`length_of`].
#[inline(always)]
pub(super) fn bounds<S: Simd>(
    s: S,
    ray: &Packet<S>,
    span: &Span<S>,
    [a, b, c]: [Vec3Lanes<S>; 3],
    length: S::F,
    wanted: u32,
    t_max: S::F,
) -> Bounds<S> {
    let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
    let from_a = sub3(s, ray.origin, a);
    let p = cross(s, ray.direction, edge2);
    let parts = Parts {
        edge1,
        edge2,
        from_a,
        p,
        q: cross(s, from_a, edge1),
        det: dot(s, edge1, p),
        length,
        distance: size3(s, from_a),
    };
    known(s, ray, span, &parts, wanted, t_max)
}

/// Rows that [`prepare`] writes.
pub(super) const PREPARED_ROWS: usize = 13;

/// Writes the parts that are the same for all rays with this in common: in rows 0–5 the edges, and from row 6 on p and the
/// determinant or the relative origin, q and the distance.
#[inline(always)]
pub(super) fn prepare<S: Simd>(s: S, common: &Common, packed: Packed<'_>, rows: &mut [Row]) {
    let ([a, b, c], at) = (packed.load_corners(s), packed.lane);
    let rows = &mut rows[..PREPARED_ROWS];
    let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
    store_rows(s, edge1, &mut rows[0..3], at);
    store_rows(s, edge2, &mut rows[3..6], at);
    match common {
        Common::Direction(direction) => {
            let p = cross(s, splat3(s, *direction), edge2);
            store_rows(s, p, &mut rows[6..9], at);
            s.store(dot(s, edge1, p), &mut rows[12].0[at..]);
        }
        Common::Origin(origin) => {
            let from_a = sub3(s, splat3(s, *origin), a);
            store_rows(s, from_a, &mut rows[6..9], at);
            store_rows(s, cross(s, from_a, edge1), &mut rows[9..12], at);
            s.store(size3(s, from_a), &mut rows[12].0[at..]);
        }
    }
}

/// [`bounds`] for a triangle prepared.
#[inline(always)]
pub(super) fn bounds_prepared<S: Simd>(
    s: S,
    ray: &Packet<S>,
    span: &Span<S>,
    triangle: Prepared<'_>,
    t_max: S::F,
) -> Bounds<S> {
    let Prepared { common, packed: Packed { group, lane }, rows } = triangle;
    let rows = &rows[..PREPARED_ROWS];
    let edge1 = splat_row3(s, &rows[0..3], lane);
    let edge2 = splat_row3(s, &rows[3..6], lane);
    let length = s.splat(group[LENGTH_ROW].0[lane]);
    let parts = match common {
        Common::Direction(_) => {
            let from_a = sub3(s, ray.origin, splat_row3(s, &group[0..3], lane));
            Parts {
                edge1,
                edge2,
                from_a,
                p: splat_row3(s, &rows[6..9], lane),
                q: cross(s, from_a, edge1),
                det: s.splat(rows[12].0[lane]),
                length,
                distance: size3(s, from_a),
            }
        }
        Common::Origin(_) => {
            let p = cross(s, ray.direction, edge2);
            Parts {
                edge1,
                edge2,
                from_a: splat_row3(s, &rows[6..9], lane),
                p,
                q: splat_row3(s, &rows[9..12], lane),
                det: dot(s, edge1, p),
                length,
                distance: s.splat(rows[12].0[lane]),
            }
        }
    };
    known(s, ray, span, &parts, u32::MAX, t_max)
}

/// a × b
#[inline(always)]
fn cross<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    let mut product = a;
    for (component, [j, k]) in product.iter_mut().zip(OTHERS) {
        *component = s.mul_sub(a[j], b[k], s.mul(a[k], b[j]));
    }
    product
}

/// The axes beside each.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// a · b
#[inline(always)]
fn dot<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> S::F {
    s.mul_add(a[0], b[0], s.mul_add(a[1], b[1], s.mul(a[2], b[2])))
}

/// The sum of the sizes of the products that the determinant of three vectors is made of.
#[inline(always)]
fn volume_of_sizes<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>, c: Vec3Lanes<S>) -> S::F {
    let (a, b, c) = (sizes(s, a), sizes(s, b), sizes(s, c));
    let mut products = a;
    for (product, [j, k]) in products.iter_mut().zip(OTHERS) {
        *product = s.mul_add(b[j], c[k], s.mul(b[k], c[j]));
    }
    dot(s, a, products)
}

/// The sizes of the components.
#[inline(always)]
fn sizes<S: Simd>(s: S, v: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [s.abs(v[0]), s.abs(v[1]), s.abs(v[2])]
}

#[inline(always)]
fn known<S: Simd>(
    s: S,
    ray: &Packet<S>,
    span: &Span<S>,
    parts: &Parts<S>,
    wanted: u32,
    t_max: S::F,
) -> Bounds<S> {
    let Parts { edge1, edge2, from_a, p, q, det, length, distance } = *parts;
    let u = dot(s, from_a, p);
    let v = dot(s, ray.direction, q);
    let w = s.sub(s.sub(det, u), v);
    let size = s.mul_add(length, s.splat(1.5), distance);
    let unit = s.mul(s.mul(length, s.splat(BOUND)), size);
    let error = s.mul_add(unit, span.largest, s.splat(TINY));

    let zero = s.splat(0.0);
    let minus_error = s.sub(zero, error);
    let w = s.mul(w, s.splat(1.0 / OF_W));
    let least = s.min(s.min(u, v), w);
    let greatest = s.max(s.max(u, v), w);
    // Certainly of different signs. What is beyond the bound is infinite or NaN and stays undecided.
    let missed = s.and(s.lt(least, minus_error), s.lt(error, greatest));
    let undecided = s.mask(wanted & !s.bits(missed));
    if s.bits(undecided) == 0 {
        return Bounds { undecided, certain: undecided, low: zero, high: zero };
    }

    let infinity = s.splat(f32::INFINITY);
    let square = s.mul(s.mul(length, s.splat(DET_BOUND)), length);
    let det_error = s.mul_add(square, span.largest, s.splat(TINY));
    let reciprocal = s.div(s.splat(1.0), det);
    let t = s.mul(dot(s, edge2, q), reciprocal);
    let t_error = s.mul_add(volume_of_sizes(s, edge2, from_a, edge1), s.splat(T_BOUND), s.splat(TINY));
    let size_of_t = s.abs(t);
    let scaled = s.mul_add(size_of_t, det_error, t_error);
    let rounding = s.mul_add(size_of_t, s.splat(ROUNDING), s.splat(f32::MIN_POSITIVE));
    let off = s.mul_add(scaled, s.mul(s.abs(reciprocal), s.splat(MARGIN)), rounding);
    let firm = s.lt(s.mul(det_error, s.splat(FIRM)), s.abs(det));
    let low = s.select(firm, s.sub(t, off), s.sub(zero, infinity));
    let high = s.select(firm, s.add(t, off), infinity);
    let gone = s.or(s.lt(t_max, low), s.lt(high, ray.t_min));
    let undecided = s.mask(s.bits(undecided) & !s.bits(gone));
    let certain = s.or(s.lt(error, least), s.lt(greatest, minus_error));
    let certain = s.and(s.and(certain, undecided), s.lt(s.max(ray.t_min, s.splat(f32::MIN_POSITIVE)), low));
    Bounds { undecided, certain, low, high }
}
