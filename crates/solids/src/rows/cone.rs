//! Cones and cylinders in rows.

use super::{Found, MAX_ROWS, Packing, Prepared, Values, along, dot, first, sub3};
use accel::solid::Shape;
use accel::{Aabb, Solid};
use lanes::Simd;
use lanes::packet::Lanes;

/// The middle of one end, the axis, the height, the radius there and by how much it grows with the height, and the box from that
/// middle on.
#[derive(Clone, Copy, Debug)]
pub struct Cones;

/// As in double precision: the line's parameter is counted from the vertex of the parabola, where the discriminant cancels
/// nothing, or from the point next to that end.
impl Packing for Cones {
    const ROWS: usize = 15;

    fn numbers(solid: &Solid) -> Option<[f32; MAX_ROWS]> {
        let Solid::Cone(cone) = solid else { return None };
        let (base, axis) = (cone.base.as_dvec3(), cone.top.as_dvec3() - cone.base.as_dvec3());
        let height = axis.length();
        let axis = (axis / height).as_vec3();
        let slope = (f64::from(cone.top_radius) - f64::from(cone.base_radius)) / height;
        let Aabb { min, max } = cone.bounds();
        let mut numbers = [0.0; MAX_ROWS];
        numbers[..3].copy_from_slice(&cone.base.to_array());
        numbers[3..6].copy_from_slice(&axis.to_array());
        numbers[6..9].copy_from_slice(&[height as f32, cone.base_radius, slope as f32]);
        numbers[9..12].copy_from_slice(&(min.as_dvec3() - base).as_vec3().to_array());
        numbers[12..].copy_from_slice(&(max.as_dvec3() - base).as_vec3().to_array());
        Some(numbers)
    }

    #[inline(always)]
    fn test<S: Simd>(s: S, ray: &Prepared<S::F>, values: &Values<S>, t_max: S::F) -> Found<S> {
        let [x, y, z, ax, ay, az, top, radius, slope, lx, ly, lz, hx, hy, hz] = *values;
        let (zero, infinity) = (s.splat(0.0), s.splat(f32::INFINITY));
        let minus_infinity = s.splat(f32::NEG_INFINITY);
        let axis = [ax, ay, az];
        let from = sub3(s, ray.origin, [x, y, z]);
        let rise = dot(s, ray.direction, axis);
        let none = s.sub(zero, rise);
        let across = along(s, ray.direction, axis, none);
        let width = dot(s, across, across);
        let middle = s.sub(zero, s.mul(dot(s, from, ray.direction), ray.inverse));
        let point = along(s, from, ray.direction, middle);
        let height = dot(s, point, axis);
        let there = s.add(radius, s.mul(slope, height));
        let growth = s.mul(slope, rise);
        let aside = along(s, point, axis, s.sub(zero, height));
        let a = s.sub(width, s.mul(growth, growth));
        let b = s.sub(dot(s, aside, across), s.mul(there, growth));
        // To the parabola's vertex, if that is no farther away than the object is long.
        let size = s.add(s.sub(hx, lx), s.add(s.sub(hy, ly), s.sub(hz, lz)));
        let reach = s.mul(s.mul(s.mul(size, size), s.mul(a, a)), ray.inverse);
        let vertex = s.select(s.lt(s.mul(b, b), reach), s.div(b, a), zero);
        let step = s.sub(middle, vertex);
        let point = along(s, from, ray.direction, step);

        let height = dot(s, point, axis);
        let level = s.eq(rise, zero);
        let to_low = s.div(s.sub(zero, height), rise);
        let to_high = s.div(s.sub(top, height), rise);
        let between = s.and(s.le(zero, height), s.le(height, top));
        let near = s.select(level, s.select(between, minus_infinity, infinity), s.min(to_low, to_high));
        let far = s.select(level, s.select(between, infinity, minus_infinity), s.max(to_low, to_high));

        let there = s.add(radius, s.mul(slope, height));
        let aside = along(s, point, axis, s.sub(zero, height));
        let b = s.sub(dot(s, aside, across), s.mul(there, growth));
        let c = s.sub(dot(s, aside, aside), s.mul(there, there));
        let square = s.sub(s.mul(b, b), s.mul(a, c));
        let root = s.sqrt(s.select(s.lt(zero, square), square, zero));
        let q = s.sub(zero, s.select(s.lt(b, zero), s.sub(b, root), s.add(b, root)));
        let flat = s.eq(q, zero);
        let one = s.select(flat, zero, s.div(q, a));
        let other = s.select(flat, zero, s.div(c, q));
        let (less, more) = (s.min(one, other), s.max(one, other));

        // Between the roots where the parabola opens upward; else before or behind them, whichever is longer in the slab.
        let opens_down = s.lt(a, zero);
        let before = s.sub(s.min(less, far), near);
        let behind = s.sub(far, s.max(more, near));
        let is_before = s.lt(behind, before);
        let down_low = s.select(is_before, minus_infinity, more);
        let down_high = s.select(is_before, less, infinity);
        let mut from_t = s.select(opens_down, down_low, less);
        let mut to_t = s.select(opens_down, down_high, more);
        // No root: nothing, or all for a line along a cylinder. What opens downward has roots, which may be one at the tip.
        let along_wall = s.and(flat, s.eq(a, zero));
        let none = s.or(s.and(s.lt(square, zero), s.le(zero, a)), s.and(along_wall, s.lt(zero, c)));
        from_t = s.select(none, infinity, s.select(along_wall, minus_infinity, from_t));
        to_t = s.select(none, minus_infinity, s.select(along_wall, infinity, to_t));

        let enters = s.max(near, from_t);
        let leaves = s.min(far, to_t);
        let crossed = s.and(s.le(enters, leaves), s.lt(s.sub(leaves, enters), infinity));
        let (within, t) = first(s, s.add(step, enters), s.add(step, leaves), ray.t_min, t_max);
        let place = along(s, from, ray.direction, t);
        let mut plain = s.mask(u32::MAX);
        for (place, [low, high]) in place.into_iter().zip([[lx, hx], [ly, hy], [lz, hz]]) {
            let above = s.le(s.sub(low, ray.half_pad), place);
            plain = s.and(plain, s.and(above, s.le(place, s.add(high, ray.half_pad))));
        }
        Found { lanes: Lanes { hit: s.and(crossed, within), t, u: zero, v: zero }, plain }
    }
}
