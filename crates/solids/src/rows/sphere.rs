//! Balls in rows.

use super::{Found, MAX_ROWS, Packing, Prepared, Values, along, dot, first, sub3};
use accel::Solid;
use lanes::Simd;
use lanes::packet::Lanes;

/// Centre and radius.
#[derive(Clone, Copy, Debug)]
pub struct Spheres;

/// The discriminant from the vector between the centre and the line's nearest point (E. Haines, J. Günther, T. Akenine-Möller 2019,
/// "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, ch. 7): an error along the ray counts by its
/// square there. The roots lie as far on either side of that point.
impl Packing for Spheres {
    const ROWS: usize = 4;
    const HAS_EXACT: bool = true;

    fn numbers(solid: &Solid) -> Option<[f32; MAX_ROWS]> {
        let Solid::Sphere(sphere) = solid else { return None };
        let mut numbers = [0.0; MAX_ROWS];
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
        Found { lanes: Lanes { hit, t, u: zero, v: zero }, plain: Self::is_plain(s, ray, values, t) }
    }
}

/// How far single precision may place the line's nearest point off, in parts of the way to the origin: 2^-19, where an account of each
/// operation comes to 22 roundings of 2^-24 at most.
const ASIDE: f32 = 1.0 / (1 << 19) as f32;

/// By how much bounds are widened for their own roundings.
const WIDER: f32 = 1.0 + 1.0 / (1 << 18) as f32;

/// What single precision can tell for certain.
#[derive(Clone, Copy)]
pub struct Bounds<S: Simd> {
    /// Which lanes may hit.
    pub maybe: S::M,
    /// Which of them certainly enter within the ray's own range.
    pub certain: S::M,
    /// What hits does so at this t or above.
    pub low: S::F,
    /// What is certain does so at this t or below.
    pub high: S::F,
}

impl Spheres {
    /// The lanes that may hit at t in `[ray.t_min, t_max]`, and where, by bounds of the errors of near rays.
    #[inline(always)]
    pub fn bounds<S: Simd>(s: S, ray: &Prepared<S::F>, values: &Values<S>, t_max: S::F) -> Bounds<S> {
        let [x, y, z, radius, ..] = *values;
        let zero = s.splat(0.0);
        let from = sub3(s, ray.origin, [x, y, z]);
        let middle = s.sub(zero, s.mul(dot(s, from, ray.direction), ray.inverse));
        let aside = along(s, from, ray.direction, middle);
        let way = s.add(s.add(s.abs(from[0]), s.abs(from[1])), s.abs(from[2]));
        // The padding stands for products that are no normal numbers.
        let off = s.mul(s.add(way, ray.half_pad), s.splat(ASIDE));
        let limit = s.mul(s.add(radius, off), s.splat(WIDER));
        let (square, most) = (dot(s, aside, aside), s.mul(limit, limit));
        // Half the chord is longer by less than `off`, and the middle is off by less than that.
        let more = s.mul(s.mul(limit, off), s.splat(8.0));
        let over = s.sub(most, square);
        let half = s.sqrt(s.mul(s.add(s.select(s.lt(zero, over), over, zero), more), ray.inverse));
        let slack = s.mul(s.abs(middle), s.splat(ASIDE));
        let reach = s.mul(s.add(half, slack), s.splat(WIDER));
        let (low, leaves) = (s.sub(middle, reach), s.add(middle, reach));
        let in_range = s.and(s.le(low, t_max), s.le(ray.t_min, leaves));
        // The chord is at least as long as what is left when twice as much is taken off, and all that was added before.
        let added = s.mul(most, s.splat(4.0 * (WIDER - 1.0)));
        let under = s.sub(over, s.add(s.mul(more, s.splat(2.0)), added));
        let least = s.sqrt(s.mul(s.select(s.lt(zero, under), under, zero), ray.inverse));
        let high = s.add(s.sub(middle, s.mul(least, s.splat(1.0 / WIDER))), slack);
        let certain = s.and(s.lt(zero, under), s.lt(ray.t_min, low));
        Bounds { maybe: s.and(s.le(square, most), in_range), certain, low, high }
    }

    /// Where places at t lie in the objects' boxes padded by half, as they are rounded.
    #[inline(always)]
    pub fn is_plain<S: Simd>(s: S, ray: &Prepared<S::F>, values: &Values<S>, t: S::F) -> S::M {
        let [x, y, z, radius, ..] = *values;
        let place = along(s, sub3(s, ray.origin, [x, y, z]), ray.direction, t);
        let far = s.max(s.abs(place[0]), s.max(s.abs(place[1]), s.abs(place[2])));
        s.le(far, s.add(radius, ray.half_pad))
    }
}
