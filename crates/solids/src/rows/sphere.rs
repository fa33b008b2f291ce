//! Balls in rows.

use super::{Found, MOST_ROWS, Packing, Prepared, Values, along, dot, first, sub3};
use accel::Solid;
use lanes::Simd;

/// Centre and radius.
#[derive(Clone, Copy, Debug)]
pub struct Spheres;

/// The discriminant from the vector between the centre and the line's nearest point (E. Haines, J. Günther, T. Akenine-Möller 2019,
/// "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, ch. 7): an error along the ray counts by its
/// square there. The roots lie as far on either side of that point.
impl Packing for Spheres {
    const ROWS: usize = 4;

    fn numbers(solid: &Solid) -> Option<[f32; MOST_ROWS]> {
        let Solid::Sphere(sphere) = solid else { return None };
        let mut numbers = [0.0; MOST_ROWS];
        numbers[..3].copy_from_slice(&sphere.center.to_array());
        numbers[3] = sphere.radius;
        Some(numbers)
    }

    #[inline(always)]
    fn test<S: Simd>(s: S, ray: &Prepared<S::F>, values: &Values<S>, t_max: S::F) -> Found<S> {
        let [x, y, z, radius, ..] = *values;
        let zero = s.splat(0.0);
        let from = sub3(s, ray.origin, [x, y, z]);
        let middle = s.sub(zero, s.mul(dot(s, from, ray.direction), ray.inverse));
        let aside = along(s, from, ray.direction, middle);
        let square = s.sub(s.mul(radius, radius), dot(s, aside, aside));
        let half = s.sqrt(s.mul(s.select(s.lt(zero, square), square, zero), ray.inverse));
        let (enters, leaves) = (s.sub(middle, half), s.add(middle, half));
        let (within, t) = first(s, enters, leaves, ray.t_min, t_max);
        let hit = s.and(s.le(zero, square), within);
        let place = along(s, from, ray.direction, t);
        let limit = s.add(radius, ray.half_pad);
        let far = s.max(s.abs(place[0]), s.max(s.abs(place[1]), s.abs(place[2])));
        Found { hit, t, plain: s.le(far, limit) }
    }
}
