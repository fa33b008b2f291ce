//! Certain misses in `f32`, in lanes.
//!
//! **The bound.** Let ε = 2^-24, D the largest component of the direction (its span), L of the edges from the
//! first corner, and S the sum of the components of the origin relative to that corner, all absolute. Differences of coordinates and
//! all operations are exact up to a factor 1 + δ, |δ| ≤ ε, and an underflow of at most 2^-150 a product.
//!
//! - Scaled u and v are sums of six products of a component each of the direction, an edge and
//!   the relative origin: at most 2DLS in all, each with at most 7 factors. Off by 14ε·DLS.
//! - The determinant likewise: at most 6DL², off by 42ε·DL².
//! - w = det − u − v adds their errors and two roundings: 32ε·DLS + 54ε·DL².
//! - Scaled t is a sum of at most 2L²S with 8 factors each: off by 16ε·L²S.
//!
//! All are below 64ε·DL(S + L) and 64ε·L²(S + L), the margin covering second-order terms, the rounding of the
//! bounds themselves and that of the comparisons of t. With 2^-30 ≤ D ≤ 2^30 and S + L < 2^45 nothing overflows, and underflows
//! add less than [`TINY`] to each. Beyond those sizes nothing is rejected here.

use super::SpannedLanes;
use crate::kernel::{cross3, dot3, sub3};
use crate::packet::Vec3Lanes;
use crate::simd::Simd;

const BOUND: f32 = 64.0 * f32::EPSILON / 2.0;

/// 2^-100
const TINY: f32 = 7.888_609e-31;

/// 2^45
const GREAT: f32 = 35_184_372_088_832.0;

/// 2^-30 and 2^30
const SPANS: [f32; 2] = [9.313_226e-10, 1_073_741_824.0];

/// The largest component of a direction, or infinity outside of the sizes that the bound is for.
#[inline(always)]
pub(super) fn span<S: Simd>(s: S, direction: &Vec3Lanes<S>) -> S::F {
    let [x, y, z] = direction.map(|d| s.abs(d));
    let span = s.max(s.max(x, y), z);
    let fits = s.and(s.le(s.splat(SPANS[0]), span), s.le(span, s.splat(SPANS[1])));
    s.select(fits, span, s.splat(f32::INFINITY))
}

/// The lanes that may be hit at t up to `t_max`. NaN, as in empty lanes, is not.
#[inline(always)]
pub(super) fn open<S: Simd>(s: S, ray: &SpannedLanes<S>, [a, b, c]: &[Vec3Lanes<S>; 3], t_max: S::F) -> S::M {
    let zero = s.splat(0.0);
    let edge1 = sub3(s, *b, *a);
    let edge2 = sub3(s, *c, *a);
    let from_a = sub3(s, ray.rays.origin, *a);
    let p = cross3(s, ray.rays.direction, edge2);
    let det = dot3(s, edge1, p);
    let u = dot3(s, from_a, p);
    let q = cross3(s, from_a, edge1);
    let v = dot3(s, ray.rays.direction, q);
    let w = s.sub(s.sub(det, u), v);
    let scaled_t = dot3(s, edge2, q);

    let largest = |v: &Vec3Lanes<S>| s.max(s.max(s.abs(v[0]), s.abs(v[1])), s.abs(v[2]));
    let length = s.max(largest(&edge1), largest(&edge2));
    let distance = s.add(s.add(s.abs(from_a[0]), s.abs(from_a[1])), s.abs(from_a[2]));
    let size = s.add(distance, length);
    let area = s.mul(s.mul(length, size), s.splat(BOUND));
    let error = s.add(s.mul(area, ray.span), s.splat(TINY));
    let t_error = s.add(s.mul(area, length), s.splat(TINY));

    let least = s.min(s.min(u, v), w);
    let greatest = s.max(s.max(u, v), w);
    // Not of certainly different signs, and not with t certainly out of range.
    let one_sign = s.or(s.le(s.sub(zero, error), least), s.le(greatest, error));
    let negative = s.lt(det, zero);
    let size_of_det = s.abs(det);
    let signed_t = s.select(negative, s.sub(zero, scaled_t), scaled_t);
    let beyond = |sign_t: S::F, limit: S::F| {
        let most = s.add(s.mul(limit, size_of_det), s.mul(s.abs(limit), error));
        s.lt(most, s.sub(sign_t, t_error))
    };
    let behind = beyond(s.sub(zero, signed_t), s.sub(zero, ray.rays.t_min));
    let out_of_range = s.and(s.or(beyond(signed_t, t_max), behind), s.lt(error, size_of_det));
    // There is no "not" of lanes: where out of range, none of the rest holds.
    let ordered = s.le(s.select(out_of_range, s.splat(1.0), zero), zero);
    let unbounded = s.or(s.le(s.splat(GREAT), size), s.lt(s.splat(f32::MAX), ray.span));
    s.or(s.and(one_sign, ordered), unbounded)
}
