//! Rings.

use super::error::Fields;
use super::{Shape, SolidError, around_disc, placed, scaled, unit};
use crate::{Aabb, Vec3};
use glam::DVec3;

/// A ring of circular section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Its middle, where the hole is.
    pub center: Vec3,
    /// The line that it goes about, of any length but 0.
    pub axis: Vec3,
    /// From the centre to the middle of the section, above 0.
    pub major: f32,
    /// The section's radius, above 0 and below `major`.
    pub minor: f32,
}

impl Shape for Torus {
    const KIND: &'static str = "torus";

    fn bounds(&self) -> Aabb {
        around_disc(self.center, self.axis, self.major, self.minor)
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let from = point - self.center.as_dvec3();
        let axis = unit(self.axis)?;
        let flat = from - axis * from.dot(axis);
        (from - flat.try_normalize()? * f64::from(self.major)).try_normalize()
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        Self {
            center: placed(self.center, scale, offset),
            axis: self.axis,
            major: scaled(self.major, scale),
            minor: scaled(self.minor, scale),
        }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        let radii = [self.major, self.minor];
        self.center.to_array().into_iter().chain(self.axis.to_array()).chain(radii).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("center", &self.center.to_array())?;
        fields.direction("axis", self.axis)?;
        fields.positive("major", self.major)?;
        fields.positive("minor", self.minor)?;
        if self.minor >= self.major {
            return fields.refuse("minor", format!("must be below `major`, which is {}", self.major));
        }
        Ok(())
    }
}
