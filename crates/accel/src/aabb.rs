//! Axis-aligned boxes.

use crate::Vec3;

/// A closed axis-aligned box. Empty when a minimum exceeds its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner of least coordinates.
    pub min: Vec3,
    /// The corner of greatest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that contains nothing: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY) };

    /// The smallest box that contains all `points`.
    #[inline]
    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::grow)
    }

    /// The smallest box that contains this one and `point`.
    #[must_use]
    #[inline]
    pub fn grow(self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box that contains both.
    #[must_use]
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the box contains no point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Edge lengths; meaningless for an empty box.
    #[inline]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// The centre, computed without overflow.
    #[inline]
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The box moved outward by `pad` on every side, and at least to the next
    /// float, so that the result contains the exact padded box.
    #[must_use]
    #[inline]
    pub fn padded(&self, pad: f32) -> Self {
        let down = |v: f32| below(v - pad);
        let up = |v: f32| -below(-(v + pad));
        Self {
            min: Vec3::new(down(self.min.x), down(self.min.y), down(self.min.z)),
            max: Vec3::new(up(self.max.x), up(self.max.y), up(self.max.z)),
        }
    }

    /// The part of the line `origin + t·direction` inside the closed box as a
    /// range of t, computed in `f64`; `None` where they don't meet.
    ///
    /// A direction component of ±0 asks whether the origin lies between the two
    /// planes; 0·∞ therefore never arises.
    #[inline(always)]
    pub fn overlap(&self, origin: Vec3, direction: Vec3) -> Option<(f64, f64)> {
        let mut near = f64::NEG_INFINITY;
        let mut far = f64::INFINITY;
        for axis in 0..3 {
            let o = f64::from(origin[axis]);
            let d = f64::from(direction[axis]);
            let lo = f64::from(self.min[axis]) - o;
            let hi = f64::from(self.max[axis]) - o;
            if d == 0.0 {
                if lo > 0.0 || hi < 0.0 {
                    return None;
                }
                continue;
            }
            let inverse = 1.0 / d;
            let (a, b) = (lo * inverse, hi * inverse);
            let (least, most) = if a < b { (a, b) } else { (b, a) };
            near = if least > near { least } else { near };
            far = if most < far { most } else { far };
        }
        (near <= far).then_some((near, far))
    }
}

/// [`f32::next_down`] of a finite number, without branches.
#[inline(always)]
fn below(v: f32) -> f32 {
    // Mirrored below 0, so that bits are ordered as integers. The zeros are two of them.
    let mirrored = |bits: i32| bits ^ (bits >> 31 & i32::MAX);
    let ordered = mirrored(v.to_bits().cast_signed());
    f32::from_bits(mirrored(ordered - 1 - i32::from(ordered == 0)).cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn below_is_the_next_float_down() {
        for v in [0.0, -0.0, 1.0, -1.0, 1e-45, -1e-45, f32::MAX, f32::MIN_POSITIVE, 1.5e5, -3.7e-9] {
            assert_eq!(below(v).to_bits(), v.next_down().to_bits(), "{v}");
        }
    }

    #[test]
    fn overlap_knows_zero_directions() {
        let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let along_x = Vec3::new(1.0, -0.0, 0.0);
        assert_eq!(unit.overlap(Vec3::new(-1.0, 0.0, 1.0), along_x), Some((1.0, 2.0)));
        assert_eq!(unit.overlap(Vec3::new(-1.0, 1.1, 1.0), along_x), None);
        assert_eq!(unit.overlap(Vec3::new(2.0, 0.5, 0.5), along_x), Some((-2.0, -1.0)));
    }

    #[test]
    fn padding_contains_the_exact_box() {
        let point = Aabb::of_points([Vec3::splat(1.5e5)]);
        let padded = point.padded(1e-9);
        assert!(padded.min.x < 1.5e5 && padded.max.x > 1.5e5);
        assert!(Aabb::EMPTY.is_empty() && !point.is_empty());
    }
}
