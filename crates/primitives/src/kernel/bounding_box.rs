//! The paper's set Q before its detail tests (Skala 1993, §2–3): an object counts as hit where the ray meets its box.
//! What is left of a ray's cost is the structure's, with six values an object instead of nine.

use super::packed::{load3, splat_row3};
use super::{Corners, Kernel, KernelId, Packed, RayForm};
use accel::{Ray, Vec3};
use lanes::packet::{Lanes, Packet, Vec3Lanes, splat3};
use lanes::{Row, Scalar, Simd};

/// Takes a triangle for its box, which is hit where the ray enters it, or leaves it if it starts inside. u and v are 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct BoundingBox;

/// Directions' components count as this at least, so that their reciprocals are finite and no product is NaN.
const MIN: f32 = 1.0 / (1u128 << 100) as f32;

/// A ray with the reciprocals of its direction.
#[derive(Clone, Copy, Debug)]
pub struct Slabs {
    origin: Vec3,
    inverse: Vec3,
    /// NaN for a ray without a finite direction, which hits nothing.
    t_min: f32,
}

/// [`Slabs`] in lanes.
#[derive(Clone, Copy)]
pub struct SlabsLanes<S: Simd> {
    origin: Vec3Lanes<S>,
    inverse: Vec3Lanes<S>,
    t_min: S::F,
}

#[inline(always)]
fn inverse<S: Simd>(s: S, component: S::F) -> S::F {
    let (zero, least) = (s.splat(0.0), s.splat(MIN));
    let least = s.select(s.lt(component, zero), s.sub(zero, least), least);
    s.div(s.splat(1.0), s.select(s.lt(s.abs(component), s.abs(least)), least, component))
}

#[inline(always)]
fn inverse3<S: Simd>(s: S, [x, y, z]: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [inverse(s, x), inverse(s, y), inverse(s, z)]
}

#[inline(always)]
fn test<S: Simd>(s: S, ray: &SlabsLanes<S>, [low, high]: [Vec3Lanes<S>; 2], t_max: S::F) -> Lanes<S> {
    let zero = s.splat(0.0);
    let infinity = s.splat(f32::INFINITY);
    let (mut near, mut far) = (s.sub(zero, infinity), infinity);
    for axis in 0..3 {
        let a = s.mul(s.sub(low[axis], ray.origin[axis]), ray.inverse[axis]);
        let b = s.mul(s.sub(high[axis], ray.origin[axis]), ray.inverse[axis]);
        near = s.max(near, s.min(a, b));
        far = s.min(far, s.max(a, b));
    }
    // Which zero a minimum of two is differs between instruction sets; adding zero makes it +0.
    let t = s.add(s.select(s.le(ray.t_min, near), near, far), zero);
    let in_range = s.and(s.le(ray.t_min, t), s.le(t, t_max));
    let met = s.and(s.le(near, far), s.lt(s.abs(t), infinity));
    Lanes { hit: s.and(met, in_range), t, u: zero, v: zero }
}

impl RayForm for Slabs {
    type Many<S: Simd> = SlabsLanes<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Self {
        let inverse = inverse3(Scalar, ray.direction.to_array());
        let t_min = if ray.direction.is_finite() { ray.t_min } else { f32::NAN };
        Slabs { origin: ray.origin, inverse: Vec3::from_array(inverse), t_min }
    }

    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> SlabsLanes<S> {
        let [x, y, z] = rays.direction.map(|component| s.abs(component));
        let finite = s.lt(s.max(s.max(x, y), z), s.splat(f32::INFINITY));
        let t_min = s.select(finite, rays.t_min, s.splat(f32::NAN));
        SlabsLanes { origin: rays.origin, inverse: inverse3(s, rays.direction), t_min }
    }
}

impl Kernel for BoundingBox {
    const ID: KernelId = KernelId::BoundingBox;
    /// The least and the greatest corner of the box.
    const ROWS: usize = 6;
    crate::plain_kernel!();
    type One = Slabs;

    #[inline(always)]
    fn pack([a, b, c]: &Corners, group: &mut [Row], lane: usize) {
        let (low, high) = (a.min(*b).min(*c), a.max(*b).max(*c));
        for axis in 0..3 {
            group[axis].0[lane] = low[axis];
            group[3 + axis].0[lane] = high[axis];
        }
    }

    #[inline(always)]
    fn corners(packed: Packed<'_>) -> Option<Corners> {
        let Packed { group, lane } = packed;
        let at = |row: usize| Vec3::new(group[row].0[lane], group[row + 1].0[lane], group[row + 2].0[lane]);
        Some([at(0), at(3), at(0)])
    }

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Slabs, packed: Packed<'_>, _: u32, t_max: f32) -> Lanes<S> {
        let Packed { group, lane } = packed;
        let ray = SlabsLanes {
            origin: splat3(s, ray.origin),
            inverse: splat3(s, ray.inverse),
            t_min: s.splat(ray.t_min),
        };
        test(s, &ray, [load3(s, &group[..3], lane), load3(s, &group[3..6], lane)], s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &SlabsLanes<S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        let Packed { group, lane } = packed;
        test(s, rays, [splat_row3(s, &group[..3], lane), splat_row3(s, &group[3..6], lane)], t_max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The box of a triangle is hit where the triangle is missed, and a flat one like a rectangle.
    #[test]
    fn boxes_are_hit_where_the_ray_enters_or_leaves() {
        let hit = |origin: Vec3, direction: Vec3, corners: [Vec3; 3]| {
            let ray = Ray::new(origin, direction);
            BoundingBox::test(&BoundingBox::one(&ray), &corners, f32::INFINITY).map(|s| s.t)
        };
        let solid = [Vec3::ZERO, Vec3::new(1.0, 1.0, 2.0), Vec3::X];
        assert_eq!(hit(Vec3::new(0.1, 0.9, 4.0), Vec3::NEG_Z, solid), Some(2.0), "enters");
        assert_eq!(hit(Vec3::new(0.1, 0.9, 0.5), Vec3::NEG_Z, solid), Some(0.5), "leaves");
        assert_eq!(hit(Vec3::new(0.1, 1.1, 4.0), Vec3::NEG_Z, solid), None);
        let flat = [Vec3::ZERO, Vec3::X, Vec3::Y];
        assert_eq!(hit(Vec3::new(0.9, 0.9, 3.0), Vec3::NEG_Z, flat), Some(3.0));
        assert_eq!(hit(Vec3::new(-1.0, 0.9, 0.0), Vec3::X, flat), None, "along the plane");
        assert_eq!(hit(Vec3::new(-1.0, 0.9, 0.1), Vec3::X, flat), None);
    }
}
