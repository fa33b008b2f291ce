//! T. Möller, B. Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection*,
//! Journal of Graphics Tools 2(1), 1997: no storage beyond the corners, one division.

use super::{Kernel, KernelId, cross3, dot3, load_corners, splat_corners, sub3};
use crate::Ray;
use crate::packet::{Lanes, Packet, Vec3Lanes};
use crate::simd::{Row, Simd};

/// Möller and Trumbore's test in `f32`, two-sided. Not watertight: neighbours round
/// their common edge differently.
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumbore;

impl Kernel for MollerTrumbore {
    const ID: KernelId = KernelId::MollerTrumbore;
    type One = Ray;
    type Many<S: Simd> = Packet<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Ray {
        *ray
    }

    #[inline(always)]
    fn many<S: Simd>(_: S, rays: &Packet<S>) -> Packet<S> {
        *rays
    }

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Ray, group: &[Row], at: usize, t_max: f32) -> Lanes<S> {
        test(s, &Packet::splat(s, ray), load_corners(s, group, at), s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &Packet<S>, group: &[Row], lane: usize, t_max: S::F) -> Lanes<S> {
        test(s, rays, splat_corners(s, group, lane), t_max)
    }
}

/// A zero determinant needs no test: its reciprocal is infinite, and u, v and their sum
/// are then infinite or NaN, which no comparison lets pass.
#[inline(always)]
fn test<S: Simd>(s: S, ray: &Packet<S>, [a, b, c]: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
    let (zero, one) = (s.splat(0.0), s.splat(1.0));
    let edge1 = sub3(s, b, a);
    let edge2 = sub3(s, c, a);
    let p = cross3(s, ray.direction, edge2);
    let reciprocal = s.div(one, dot3(s, edge1, p));
    let from_a = sub3(s, ray.origin, a);
    let u = s.mul(dot3(s, from_a, p), reciprocal);
    let q = cross3(s, from_a, edge1);
    let v = s.mul(dot3(s, ray.direction, q), reciprocal);
    let t = s.mul(dot3(s, edge2, q), reciprocal);
    let inside = s.and(s.and(s.le(zero, u), s.le(zero, v)), s.le(s.add(u, v), one));
    let in_range = s.and(s.le(ray.t_min, t), s.le(t, t_max));
    Lanes { hit: s.and(inside, in_range), t, u, v }
}
