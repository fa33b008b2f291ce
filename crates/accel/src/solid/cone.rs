//! Cones and cylinders.

use super::error::Fields;
use super::{Shape, SolidError, outward, placed, reach, scaled};
use crate::{Aabb, Vec3};
use glam::DVec3;

/// A cone that is cut off at both ends and capped there; a cylinder where the radii are equal, with a tip where one is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The middle of one end.
    pub base: Vec3,
    /// Its radius, 0 or more.
    pub base_radius: f32,
    /// The middle of the other end.
    pub top: Vec3,
    /// Its radius, 0 or more, and not 0 where the other is.
    pub top_radius: f32,
}

impl Shape for Cone {
    const KIND: &'static str = "cone";

    fn bounds(&self) -> Aabb {
        let (base, top) = (self.base.as_dvec3(), self.top.as_dvec3());
        let around = reach((top - base).normalize_or_zero());
        let (low, high) = (around * f64::from(self.base_radius), around * f64::from(self.top_radius));
        outward((base - low).min(top - high), (base + low).max(top + high))
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let (base, top) = (self.base.as_dvec3(), self.top.as_dvec3());
        let (height, axis) = ((top - base).length(), (top - base).try_normalize()?);
        let along = (point - base).dot(axis);
        let outward = point - base - axis * along;
        let (low, high) = (f64::from(self.base_radius), f64::from(self.top_radius));
        let slope = (low - high) / height;
        let side = (outward.length() - (low - slope * along)).abs() / slope.hypot(1.0);
        if along.abs() < side && along.abs() <= (along - height).abs() {
            return Some(-axis);
        }
        if (along - height).abs() < side {
            return Some(axis);
        }
        (outward.normalize_or_zero() + axis * slope).try_normalize()
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        Self {
            base: placed(self.base, scale, offset),
            base_radius: scaled(self.base_radius, scale),
            top: placed(self.top, scale, offset),
            top_radius: scaled(self.top_radius, scale),
        }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.base.to_array().into_iter().for_each(&mut *see);
        see(self.base_radius);
        self.top.to_array().into_iter().for_each(&mut *see);
        see(self.top_radius);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("base", &self.base.to_array())?;
        fields.finite("top", &self.top.to_array())?;
        for (field, radius) in [("base_radius", self.base_radius), ("top_radius", self.top_radius)] {
            fields.finite(field, &[radius])?;
            if radius < 0.0 {
                return fields.refuse(field, format!("must be 0 or more, not {radius}"));
            }
        }
        if self.base_radius == 0.0 && self.top_radius == 0.0 {
            return fields.refuse("base_radius", "and `top_radius` must not both be 0");
        }
        if self.top == self.base {
            return fields.refuse("top", "must not be where `base` is");
        }
        Ok(())
    }
}
