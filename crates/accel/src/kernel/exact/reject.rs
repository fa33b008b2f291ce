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

use crate::kernel::{cross3, dot3, sub3};
use crate::packet::{Packet, Vec3Lanes};
use crate::simd::{Scalar, Simd};

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

/// The lanes that may be hit at t up to `t_max`, as bits. NaN, as in empty lanes, is not.
#[inline(always)]
pub(super) fn open<S: Simd>(
    s: S,
    ray: &Packet<S>,
    span: &Span<S>,
    [a, b, c]: [Vec3Lanes<S>; 3],
    t_max: S::F,
) -> u32 {
    let edge1 = sub3(s, b, a);
    let edge2 = sub3(s, c, a);
    let from_a = sub3(s, ray.origin, a);
    let p = cross3(s, ray.direction, edge2);
    let det = dot3(s, edge1, p);
    let u = dot3(s, from_a, p);
    let q = cross3(s, from_a, edge1);
    let v = dot3(s, ray.direction, q);
    let w = s.sub(s.sub(det, u), v);

    let length = s.max(largest3(s, edge1), largest3(s, edge2));
    let distance = s.add(s.add(s.abs(from_a[0]), s.abs(from_a[1])), s.abs(from_a[2]));
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
