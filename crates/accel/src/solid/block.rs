//! Boxes as one kind among others.

use super::error::Fields;
use super::{Shape, SolidError, placed};
use crate::Aabb;
use glam::DVec3;

impl Shape for Aabb {
    const KIND: &'static str = "box";

    fn bounds(&self) -> Aabb {
        *self
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        let gap = (point - min).abs().min((point - max).abs());
        let axis = (0..3).min_by(|a, b| gap[*a].total_cmp(&gap[*b]))?;
        let low = (point[axis] - min[axis]).abs() <= (point[axis] - max[axis]).abs();
        Some(if low { -DVec3::AXES[axis] } else { DVec3::AXES[axis] })
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        Self { min: placed(self.min, scale, offset), max: placed(self.max, scale, offset) }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.min.to_array().into_iter().chain(self.max.to_array()).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("min", &self.min.to_array())?;
        fields.finite("max", &self.max.to_array())?;
        if self.is_empty() {
            return fields.refuse("min", "must not be above `max` in any coordinate");
        }
        Ok(())
    }
}
