//! Flat discs.

use super::error::Fields;
use super::{Shape, SolidError, around_disc, placed, scaled, unit};
use crate::{Aabb, Vec3};
use glam::DVec3;

/// A flat disc, seen from both sides. It is no closed object: it has no inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its middle.
    pub center: Vec3,
    /// Of any length but 0.
    pub normal: Vec3,
    /// Above 0.
    pub radius: f32,
}

impl Shape for Disc {
    const KIND: &'static str = "disc";

    fn bounds(&self) -> Aabb {
        around_disc(self.center, self.normal, self.radius, 0.0)
    }

    fn normal(&self, _: DVec3) -> Option<DVec3> {
        unit(self.normal)
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        let center = placed(self.center, scale, offset);
        Self { center, normal: self.normal, radius: scaled(self.radius, scale) }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.center.to_array().into_iter().chain(self.normal.to_array()).chain([self.radius]).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("center", &self.center.to_array())?;
        fields.direction("normal", self.normal)?;
        fields.positive("radius", self.radius)
    }
}
