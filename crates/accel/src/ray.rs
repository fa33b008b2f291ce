//! Rays and hits.

use crate::Vec3;
use std::fmt;

/// A ray: the points `origin + t·direction` for t in the closed range
/// `[t_min, t_max]`. The direction need not be of unit length; t is in units of it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Ray {
    /// The point at t = 0.
    pub origin: Vec3,
    /// Finite and not zero.
    pub direction: Vec3,
    /// Least t of a hit, finite.
    pub t_min: f32,
    /// Greatest t of a hit, which may be infinite.
    pub t_max: f32,
}

impl Ray {
    /// The ray from `origin` towards `direction` with t from 0 on.
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The point at `t`, rounded.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }

    /// Origin, direction, least and greatest t, in this order.
    #[inline(always)]
    pub fn quads(&self) -> &[[f32; 4]; 2] {
        bytemuck::cast_ref(self)
    }

    /// Whether structures accept this ray.
    ///
    /// # Errors
    /// Says which part of the ray is unusable.
    pub fn validate(&self) -> Result<(), RayError> {
        if !self.origin.is_finite() {
            return Err(RayError::Origin(self.origin));
        }
        if !self.direction.is_finite() {
            return Err(RayError::Direction(self.direction));
        }
        if self.direction == Vec3::ZERO {
            return Err(RayError::ZeroDirection);
        }
        if !self.t_min.is_finite() || self.t_max.is_nan() {
            return Err(RayError::Range(self.t_min, self.t_max));
        }
        Ok(())
    }
}

/// Why a ray can't be traced.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RayError {
    /// NaN or infinite origin.
    #[error("the ray's origin {0} is not finite")]
    Origin(Vec3),
    /// NaN or infinite direction.
    #[error("the ray's direction {0} is not finite")]
    Direction(Vec3),
    /// No direction at all.
    #[error("the ray's direction is zero")]
    ZeroDirection,
    /// An origin farther from the scene than structures are right for.
    #[error("the ray's origin {0} is more than 2^100 times as far from the scene as the scene is long")]
    Far(Vec3),
    /// NaN in the range, or a range that begins at infinity or minus infinity: t there names no point.
    #[error("the ray's range [{0}, {1}] does not begin at a finite t, or has no end")]
    Range(f32, f32),
}

/// Where a ray meets an object, and which.
#[derive(Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Hit {
    /// The ray's parameter at the hit.
    pub t: f32,
    /// The object's number in the scene.
    pub object: u32,
    /// First surface coordinate: for a triangle the weight of its second corner.
    pub u: f32,
    /// Second surface coordinate: for a triangle the weight of its third corner.
    pub v: f32,
}

impl Hit {
    /// Equality of every bit, the equality that checks ask for (−0.0 ≠ 0.0).
    #[inline]
    pub fn same_bits(&self, other: &Self) -> bool {
        self.t.to_bits() == other.t.to_bits()
            && self.object == other.object
            && self.u.to_bits() == other.u.to_bits()
            && self.v.to_bits() == other.v.to_bits()
    }
}

impl fmt::Debug for Hit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { t, object, u, v } = self;
        write!(f, "Hit {{ t: {t:?}, object: {object}, u: {u:?}, v: {v:?} }}")
    }
}

/// Where a ray meets a known object: a [`Hit`] without the object's number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The ray's parameter at the hit.
    pub t: f32,
    /// First surface coordinate.
    pub u: f32,
    /// Second surface coordinate.
    pub v: f32,
}

/// The nearest hit so far of a ray under way. Nearest t wins; on equal t the lowest
/// object number, so that the order of tests never shows in the answer.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Nearest {
    /// The hit's t, or the ray's `t_max` while there is none.
    pub t: f32,
    /// The hit's object, or [`Nearest::NONE`].
    pub object: u32,
    /// First surface coordinate.
    pub u: f32,
    /// Second surface coordinate.
    pub v: f32,
}

impl Nearest {
    /// The object number that stands for "no hit yet". Scenes hold fewer objects.
    pub const NONE: u32 = u32::MAX;

    /// No hit yet; `t_max` itself is still within reach.
    #[inline]
    pub const fn new(t_max: f32) -> Self {
        Self { t: t_max, object: Self::NONE, u: 0.0, v: 0.0 }
    }

    /// t, the bits of the object's number, and both surface coordinates, in this order.
    #[inline(always)]
    pub fn quad(&self) -> &[f32; 4] {
        bytemuck::cast_ref(self)
    }

    /// The inverse of [`Nearest::quad`].
    #[inline(always)]
    pub fn of_quad(quad: [f32; 4]) -> Self {
        bytemuck::cast(quad)
    }

    /// Takes a hit on `object` if it comes before what is here.
    #[inline]
    pub fn offer(&mut self, object: u32, surface: Surface) {
        self.offer_by(object, surface, |other| object < other);
    }

    /// [`Nearest::offer`], with `precedes` to say whether `object` comes before the other object hit at
    /// the same reported t.
    #[inline(always)]
    pub fn offer_by(&mut self, object: u32, surface: Surface, precedes: impl FnOnce(u32) -> bool) {
        let tie = || self.object == Self::NONE || (self.object != object && precedes(self.object));
        if surface.t < self.t || (surface.t == self.t && tie()) {
            *self = Self { t: surface.t, object, u: surface.u, v: surface.v };
        }
    }

    /// The hit, if there is one.
    #[inline]
    pub fn hit(&self) -> Option<Hit> {
        // As a whole, so that it is copied as one.
        (self.object != Self::NONE).then_some(bytemuck::cast(*self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_go_to_the_lowest_object_in_any_order() {
        let at = |t| Surface { t, u: 0.0, v: 0.0 };
        for order in [[3, 1, 2], [1, 2, 3], [2, 3, 1]] {
            let mut nearest = Nearest::new(5.0);
            for id in order {
                nearest.offer(id, at(5.0));
            }
            assert_eq!(nearest.hit().map(|h| h.object), Some(1));
        }
    }

    #[test]
    fn unusable_rays_are_named() {
        let zero = Ray::new(Vec3::ZERO, Vec3::new(0.0, -0.0, 0.0));
        assert_eq!(zero.validate(), Err(RayError::ZeroDirection));
        assert!(Ray::new(Vec3::NAN, Vec3::X).validate().is_err());
        for t_min in [f32::NEG_INFINITY, f32::INFINITY, f32::NAN] {
            let ray = Ray { t_min, ..Ray::new(Vec3::ZERO, Vec3::X) };
            assert!(matches!(ray.validate(), Err(RayError::Range(..))), "{t_min}");
        }
        assert!(Ray::new(Vec3::ZERO, Vec3::X).validate().is_ok());
    }
}
