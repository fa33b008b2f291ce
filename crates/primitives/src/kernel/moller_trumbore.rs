//! T. Möller, B. Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection*,
//! Journal of Graphics Tools 2(1), 1997: no storage beyond the corners, one division.

use super::packed::splat_row3;
use super::{
    EdgeError, Floats, InPairs, Kernel, KernelId, Packed, Paired, Permuted, Preparation, Prepared, cross3,
    dot3, store_rows, sub3,
};
use accel::{Common, Ray};
use lanes::packet::{Lanes, Packet, Vec3Lanes, splat3};
use lanes::{Row, Simd};

/// Möller and Trumbore's test in `f32`, two-sided. Not watertight: neighbours round
/// their common edge differently.
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumbore;

impl Kernel for MollerTrumbore {
    const ID: KernelId = KernelId::MollerTrumbore;
    type Preparation = Self;
    type Search = InPairs;
    type Storage = Floats;
    type One = Ray;
    const EDGE_ERROR: Option<EdgeError> = Some(EdgeError::Edge);

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Ray, packed: Packed<'_>, _: u32, t_max: f32) -> Lanes<S> {
        test(s, &Packet::splat(s, ray), packed.load_corners(s), s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &Packet<S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        test(s, rays, packed.splat_corners(s), t_max)
    }
}

impl Permuted for MollerTrumbore {
    #[inline(always)]
    fn permuted<S: Simd>(s: S, rays: &Packet<S>, at: S::U) -> Packet<S> {
        rays.permuted(s, at)
    }
}

impl Paired for MollerTrumbore {
    #[inline(always)]
    fn each<S: Simd>(s: S, rays: &Packet<S>, corners: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
        test(s, rays, corners, t_max)
    }
}

impl Preparation<Self> for MollerTrumbore {
    const ROWS: usize = 13;

    #[inline(always)]
    fn prepare<S: Simd>(s: S, common: &Common, packed: Packed<'_>, rows: &mut [Row]) {
        let at = packed.lane;
        let rows = &mut rows[..<Self as Preparation<Self>>::ROWS];
        let [a, b, c] = packed.load_corners(s);
        let edge1 = sub3(s, b, a);
        let edge2 = sub3(s, c, a);
        store_rows(s, edge1, &mut rows[0..3], at);
        store_rows(s, edge2, &mut rows[3..6], at);
        match common {
            Common::Direction(direction) => {
                let p = cross3(s, splat3(s, *direction), edge2);
                let reciprocal = s.div(s.splat(1.0), dot3(s, edge1, p));
                store_rows(s, p, &mut rows[6..9], at);
                s.store(reciprocal, &mut rows[12].0[at..]);
            }
            Common::Origin(origin) => {
                let from_a = sub3(s, splat3(s, *origin), a);
                let q = cross3(s, from_a, edge1);
                store_rows(s, from_a, &mut rows[6..9], at);
                store_rows(s, q, &mut rows[9..12], at);
                s.store(dot3(s, edge2, q), &mut rows[12].0[at..]);
            }
        }
    }

    #[inline(always)]
    fn rays_prepared<S: Simd>(s: S, rays: &Packet<S>, prepared: Prepared<'_>, t_max: S::F) -> Lanes<S> {
        let Prepared { common, packed: Packed { group, lane }, rows } = prepared;
        let (zero, one) = (s.splat(0.0), s.splat(1.0));
        let (edge1, edge2) = (splat_row3(s, &rows[0..3], lane), splat_row3(s, &rows[3..6], lane));
        let last = s.splat(rows[12].0[lane]);
        let (u, v, t) = match common {
            Common::Direction(direction) => {
                let (p, reciprocal) = (splat_row3(s, &rows[6..9], lane), last);
                let a = splat_row3(s, &group[0..3], lane);
                let from_a = sub3(s, rays.origin, a);
                let q = cross3(s, from_a, edge1);
                let direction = splat3(s, *direction);
                (
                    s.mul(dot3(s, from_a, p), reciprocal),
                    s.mul(dot3(s, direction, q), reciprocal),
                    s.mul(dot3(s, edge2, q), reciprocal),
                )
            }
            Common::Origin(_) => {
                let (from_a, q) = (splat_row3(s, &rows[6..9], lane), splat_row3(s, &rows[9..12], lane));
                let p = cross3(s, rays.direction, edge2);
                let reciprocal = s.div(one, dot3(s, edge1, p));
                (
                    s.mul(dot3(s, from_a, p), reciprocal),
                    s.mul(dot3(s, rays.direction, q), reciprocal),
                    s.mul(last, reciprocal),
                )
            }
        };
        let inside = s.and(s.and(s.le(zero, u), s.le(zero, v)), s.le(s.add(u, v), one));
        let in_range = s.and(s.le(rays.t_min, t), s.le(t, t_max));
        Lanes { hit: s.and(inside, in_range), t, u, v }
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
