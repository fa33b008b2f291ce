//! Triangles in rows.

use super::{Found, MAX_ROWS, Packing, Prepared, Values, along, dot, sub3};
use accel::Solid;
use lanes::Simd;
use lanes::packet::{Lanes, Vec3Lanes};

/// The first corner, and the edges from it to the others.
#[derive(Clone, Copy, Debug)]
pub struct Triangles;

/// T. Möller, B. Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
impl Packing for Triangles {
    const ROWS: usize = 9;

    fn numbers(solid: &Solid) -> Option<[f32; MAX_ROWS]> {
        let Solid::Triangle([a, b, c]) = solid else { return None };
        let mut numbers = [0.0; MAX_ROWS];
        numbers[..3].copy_from_slice(&a.to_array());
        numbers[3..6].copy_from_slice(&(*b - *a).to_array());
        numbers[6..9].copy_from_slice(&(*c - *a).to_array());
        Some(numbers)
    }

    #[inline(always)]
    fn test<S: Simd>(s: S, ray: &Prepared<S::F>, values: &Values<S>, t_max: S::F) -> Found<S> {
        let [x, y, z, e0, e1, e2, f0, f1, f2, ..] = *values;
        let (one_edge, other_edge) = ([e0, e1, e2], [f0, f1, f2]);
        let (zero, one) = (s.splat(0.0), s.splat(1.0));
        let from = sub3(s, ray.origin, [x, y, z]);
        let p = cross(s, ray.direction, other_edge);
        let inverse = s.div(one, dot(s, one_edge, p));
        let u = s.mul(dot(s, from, p), inverse);
        let q = cross(s, from, one_edge);
        let v = s.mul(dot(s, ray.direction, q), inverse);
        let t = s.add(s.mul(dot(s, other_edge, q), inverse), zero);
        // No comparison holds where the determinant is zero.
        let inside = s.and(s.and(s.le(zero, u), s.le(zero, v)), s.le(s.add(u, v), one));
        let hit = s.and(inside, s.and(s.le(ray.t_min, t), s.le(t, t_max)));
        let place = along(s, from, ray.direction, t);
        let mut plain = s.mask(u32::MAX);
        for ((place, e), f) in place.into_iter().zip(one_edge).zip(other_edge) {
            let low = s.sub(s.min(zero, s.min(e, f)), ray.half_pad);
            let high = s.add(s.max(zero, s.max(e, f)), ray.half_pad);
            plain = s.and(plain, s.and(s.le(low, place), s.le(place, high)));
        }
        Found { lanes: Lanes { hit, t, u: s.add(u, zero), v: s.add(v, zero) }, plain }
    }
}

#[inline(always)]
fn cross<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [
        s.sub(s.mul(a[1], b[2]), s.mul(a[2], b[1])),
        s.sub(s.mul(a[2], b[0]), s.mul(a[0], b[2])),
        s.sub(s.mul(a[0], b[1]), s.mul(a[1], b[0])),
    ]
}
