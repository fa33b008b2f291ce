//! Lines that begin far from what they meet.
//!
//! From R extents away `f64` tells a point of a line to R·2^-52 extents, which from 2^34 on is more than the margins of
//! [`crate::tolerance`]. There the origin is first moved along the line to the box, without error: each step is a
//! multiple of the direction by a number of 24 bits, which `f64` holds, and what is left of the origin after it takes
//! few bits more.

use crate::Vec3;

/// A line meets a box for a part of its way that is less than this of the way there, or misses it by as little: then
/// rounding counts. It is 2^8 times what [`crate::tolerance::GRID_MARGIN`] lets rounding be.
pub const BRIEFLY: f64 = 1.0 / (1 << 26) as f64;

/// Steps at most: each takes 23 bits of a distance away, and `f32` has 277.
const STEPS: usize = 13;

/// Whether a range of t on the line through a box is too short beside t itself for `f64` to say where it is.
#[inline(always)]
pub fn is_brief(near: f64, far: f64, part: f64) -> bool {
    let (a, b) = (near.abs(), far.abs());
    (far - near).abs() < part * if a > b { a } else { b }
}

/// A line and the part of it in a box.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The origin, or another point of the line.
    pub origin: [f64; 3],
    /// The line's t at [`Line::origin`]; the others are counted from there.
    pub moved: f64,
    /// Where the line enters the box.
    pub near: f64,
    /// Where it leaves it; before [`Line::near`] if they don't meet.
    pub far: f64,
    /// How long the box is in t, where the origin was moved; 0 else.
    length: f64,
}

impl Line {
    /// The part of a line in the box with these least and greatest coordinates, seen from close by where that matters.
    #[inline(always)]
    pub fn through(corners: [Vec3; 2], origin: Vec3, direction: Vec3) -> Self {
        Self::unmoved(corners, origin, direction).unwrap_or_else(|| Self::moved(corners, origin, direction))
    }

    /// [`Line::through`] with the origin where it is, or `None` where it has to be moved.
    #[inline(always)]
    pub fn unmoved(corners: [Vec3; 2], origin: Vec3, direction: Vec3) -> Option<Self> {
        let at = origin.to_array().map(f64::from);
        let (near, far) = range(corners, at, direction);
        (!is_brief(near, far, BRIEFLY)).then_some(Self { origin: at, moved: 0.0, near, far, length: 0.0 })
    }

    /// What the ends of a range of t, counted from [`Line::moved`] on, are rounded by parts of: [`crate::tolerance::TOUCH`].
    ///
    /// After moving, what is near 0 for one box is as far away as a box is long for another in the same place, and
    /// is rounded accordingly: that much is granted to both.
    #[inline(always)]
    pub fn scale(&self, start: f64, end: f64) -> f64 {
        start.abs().max(end.abs()) + self.length
    }

    /// The part in a box of a line whose origin is moved to it.
    #[cold]
    pub fn moved(corners: [Vec3; 2], origin: Vec3, direction: Vec3) -> Self {
        let [min, max] = corners;
        let center = [0, 1, 2].map(|a| 0.5 * f64::from(min[a]) + 0.5 * f64::from(max[a]));
        let d = direction.to_array().map(f64::from);
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let (mut at, mut moved) = (origin.to_array().map(f64::from), 0.0);
        // What the sums are off by, for coordinates far from 0 have no places left for small steps.
        let mut error = [0.0; 3];
        for _ in 0..STEPS {
            let along = (0..3).map(|a| (center[a] - at[a]) * d[a]).sum::<f64>();
            let step = short(along / square);
            let next = [0, 1, 2].map(|a| at[a] + step * d[a]);
            if step == 0.0 || !step.is_finite() || next == at {
                break;
            }
            for a in 0..3 {
                error[a] += lost(at[a], step * d[a], next[a]);
            }
            (at, moved) = (next, moved + step);
        }
        let (near, far) = range_beside(corners, at, error, direction);
        let length = f64::from((max - min).max_element()) / f64::from(direction.abs().max_element());
        let length = if length.is_finite() { length } else { 0.0 };
        Self { origin: at, moved, near, far, length }
    }
}

/// A number cut to the 24 bits of an `f32`, of any size.
fn short(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & (u64::MAX << 29))
}

/// What the rounded sum of two numbers lacks (D. E. Knuth, The Art of Computer Programming, vol. 2, 4.2.2, theorem B).
fn lost(a: f64, b: f64, sum: f64) -> f64 {
    let of_b = sum - a;
    (a - (sum - of_b)) + (b - of_b)
}

/// Where a line enters and leaves a box, in `f64`. A direction component of ±0 asks whether the origin lies between the
/// two planes; 0·∞ therefore never arises.
#[inline(always)]
pub fn range(corners: [Vec3; 2], origin: [f64; 3], direction: Vec3) -> (f64, f64) {
    range_beside(corners, origin, [0.0; 3], direction)
}

/// [`range`] for an origin that is the sum of a point and a small `beside`.
#[inline(always)]
fn range_beside([min, max]: [Vec3; 2], origin: [f64; 3], beside: [f64; 3], direction: Vec3) -> (f64, f64) {
    let mut near = f64::NEG_INFINITY;
    let mut far = f64::INFINITY;
    for axis in 0..3 {
        let d = f64::from(direction[axis]);
        let lo = f64::from(min[axis]) - origin[axis] - beside[axis];
        let hi = f64::from(max[axis]) - origin[axis] - beside[axis];
        if d == 0.0 {
            if lo > 0.0 || hi < 0.0 {
                return (f64::INFINITY, f64::NEG_INFINITY);
            }
            continue;
        }
        let inverse = 1.0 / d;
        let (a, b) = (lo * inverse, hi * inverse);
        let (least, most) = if a < b { (a, b) } else { (b, a) };
        near = if least > near { least } else { near };
        far = if most < far { most } else { far };
    }
    (near, far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_a_box_is_met_from_any_distance() {
        let corners = [Vec3::new(0.9, 1.9, -3.1), Vec3::new(1.1, 2.1, -2.9)];
        for power in (0..120).step_by(3) {
            let far = 2f32.powi(power);
            // Whole numbers of the far end's last place, so that the line passes (1, 2, −3) without rounding.
            let direction = Vec3::new(3.0, -5.0, 7.0) * far;
            let origin = Vec3::new(1.0, 2.0, -3.0) - direction;
            let exact = (0..3).all(|a| {
                let o = f64::from(origin[a]) + f64::from(direction[a]);
                (o - [1.0, 2.0, -3.0][a]).abs() < 0.01
            });
            let line = Line::moved(corners, origin, direction);
            assert!(!exact || line.near <= line.far, "2^{power}: {line:?}");
            let line = Line::moved(corners.map(|corner| corner + 0.3), origin, direction);
            assert!(!exact || line.near > line.far, "2^{power}: {line:?}");
        }
    }

    #[test]
    fn lines_without_direction_end_the_search() {
        let corners = [Vec3::ZERO, Vec3::ONE];
        for direction in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            let line = Line::moved(corners, Vec3::splat(1e30), direction);
            assert!(line.near > line.far || direction != Vec3::ZERO);
        }
    }
}
