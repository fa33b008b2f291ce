//! Solids given by implicit functions F(x, y, z).

use super::error::Fields;
use super::expression::{Expression, Gradient};
use super::{Shape, SolidError, placed};
use crate::Aabb;
use glam::DVec3;
use std::sync::Arc;

/// Where F(x, y, z) < 0 within a box: a closed object, whose surface is where F changes its sign and, where F < 0, the box's
/// faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Implicit {
    /// F.
    pub function: Arc<Expression>,
    /// What is outside of it does not count.
    pub bounds: Aabb,
    /// F is of (p − offset)/scale.
    scale: f64,
    offset: DVec3,
}

impl Implicit {
    /// F within a box.
    pub fn new(function: Arc<Expression>, bounds: Aabb) -> Self {
        Self { function, bounds, scale: 1.0, offset: DVec3::ZERO }
    }

    /// From the scene's coordinates to F's: the least F is counted from, and the factor.
    pub fn frame(&self) -> (DVec3, f64) {
        (self.offset, 1.0 / self.scale)
    }

    /// F with its gradient at a point of the scene.
    pub fn gradient(&self, point: DVec3) -> Gradient {
        let Gradient { value, slope } = self.function.value(Gradient::at((point - self.offset) / self.scale));
        Gradient { value, slope: slope / self.scale }
    }
}

impl Shape for Implicit {
    const KIND: &'static str = "implicit";

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let Gradient { value, slope } = self.gradient(point);
        // About how far the surface F = 0 is away, and how far the nearest face.
        let away = value.abs() / slope.length().max(f64::MIN_POSITIVE);
        let (face, gap) = nearest_face(&self.bounds, point);
        if gap < away {
            return Some(face);
        }
        slope.try_normalize()
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        let moved = |p| placed(p, scale, offset);
        Self {
            function: self.function.clone(),
            bounds: Aabb { min: moved(self.bounds.min), max: moved(self.bounds.max) },
            scale: self.scale * scale,
            offset: self.offset * scale + offset,
        }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.function.text().bytes().map(f32::from).for_each(&mut *see);
        let place = self.offset.as_vec3();
        let corners = self.bounds.min.to_array().into_iter().chain(self.bounds.max.to_array());
        corners.chain(place.to_array()).chain([self.scale as f32]).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("min", &self.bounds.min.to_array())?;
        fields.finite("max", &self.bounds.max.to_array())?;
        if self.bounds.is_empty() {
            return fields.refuse("min", "must be below `max`, coordinate by coordinate");
        }
        Ok(())
    }
}

/// The outward normal of the box's face that is nearest to a point, and how far it is.
pub(super) fn nearest_face(bounds: &Aabb, point: DVec3) -> (DVec3, f64) {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let faces = (0..3).flat_map(|axis| {
        let normal = DVec3::AXES[axis];
        [(-normal, (point[axis] - min[axis]).abs()), (normal, (point[axis] - max[axis]).abs())]
    });
    faces.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((DVec3::Z, f64::INFINITY))
}
