//! Balls.

use super::error::Fields;
use super::{Shape, SolidError, outward, placed, scaled};
use crate::{Aabb, Vec3};
use glam::DVec3;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its middle, finite.
    pub center: Vec3,
    /// Above 0.
    pub radius: f32,
}

impl Shape for Sphere {
    const KIND: &'static str = "sphere";

    fn bounds(&self) -> Aabb {
        let (center, radius) = (self.center.as_dvec3(), DVec3::splat(f64::from(self.radius)));
        outward(center - radius, center + radius)
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        (point - self.center.as_dvec3()).try_normalize()
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        Self { center: placed(self.center, scale, offset), radius: scaled(self.radius, scale) }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.center.to_array().into_iter().chain([self.radius]).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("center", &self.center.to_array())?;
        fields.positive("radius", self.radius)
    }
}
