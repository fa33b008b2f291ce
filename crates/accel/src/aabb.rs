//! Axis-aligned boxes.

use crate::Vec3;
use crate::far::{self, Line};
use glam::{Vec3A, Vec4};

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
        let pad = Vec3A::splat(pad);
        let (min, max) = (Vec3A::from(self.min) - pad, Vec3A::from(self.max) + pad);
        Self { min: below(min).into(), max: (-below(-max)).into() }
    }

    /// The part of the line `origin + t·direction` inside the closed box as a
    /// range of t, computed in `f64`; `None` where they don't meet.
    ///
    /// It is right from any distance, see [`crate::far`].
    #[inline(always)]
    pub fn overlap(&self, origin: Vec3, direction: Vec3) -> Option<(f64, f64)> {
        let (near, far) = far::range([self.min, self.max], origin.to_array().map(f64::from), direction);
        if far::is_brief(near, far, UNDECIDED) {
            let Line { moved, near, far, .. } = Line::moved([self.min, self.max], origin, direction);
            return (near <= far).then_some((moved + near, moved + far));
        }
        (near <= far).then_some((near, far))
    }
}

/// What [`far::range`] tells apart by more than this relatively, it tells for certain: 2^11 times its rounding.
const UNDECIDED: f64 = 1.0 / (1u64 << 40) as f64;

/// [`f32::next_down`] of finite coordinates, without branches.
#[inline(always)]
fn below(point: Vec3A) -> Vec3A {
    // Mirrored below 0, so that bits are ordered as integers. The zeros are two of them.
    let mirrored = |bits: i32| bits ^ (bits >> 31 & i32::MAX);
    // In four lanes: of three the compiler makes no vector.
    let mut lanes = Vec4::from((point, 0.0)).to_array();
    for lane in &mut lanes {
        let ordered = mirrored(lane.to_bits().cast_signed());
        *lane = f32::from_bits(mirrored(ordered - 1 - i32::from(ordered == 0)).cast_unsigned());
    }
    Vec3A::from_vec4(Vec4::from_array(lanes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn below_is_the_next_float_down() {
        for v in [0.0, -0.0, 1.0, -1.0, 1e-45, -1e-45, f32::MAX, f32::MIN_POSITIVE, 1.5e5, -3.7e-9] {
            let next = v.next_down();
            for (point, wanted) in [([v, 1.0, 2.0], 0), ([1.0, v, 2.0], 1), ([1.0, 2.0, v], 2)] {
                assert_eq!(below(Vec3A::from_array(point))[wanted].to_bits(), next.to_bits(), "{v}");
            }
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
