//! Quadrics in general position.

use super::error::Fields;
use super::{Shape, SolidError};
use crate::Aabb;
use glam::DVec3;

/// Where F(x, y, z) ≤ 0 within a box, for F of the second degree: a closed object, whose surface is where F = 0 and,
/// where F < 0, the box's faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    /// Of x², y², z², 2xy, 2xz, 2yz, 2x, 2y, 2z and 1, the coordinates being counted from the middle of `bounds`.
    pub coefficients: [f32; 10],
    /// What is outside of it does not count.
    pub bounds: Aabb,
}

impl Quadric {
    /// Where the coordinates of F are counted from.
    pub fn center(&self) -> DVec3 {
        (self.bounds.min.as_dvec3() + self.bounds.max.as_dvec3()) * 0.5
    }

    /// F's gradient, halved, at a point counted from the centre.
    pub fn half_gradient(&self, p: DVec3) -> DVec3 {
        let [xx, yy, zz, xy, xz, yz, x, y, z, _] = self.coefficients.map(f64::from);
        DVec3::new(
            xx * p.x + xy * p.y + xz * p.z + x,
            xy * p.x + yy * p.y + yz * p.z + y,
            xz * p.x + yz * p.y + zz * p.z + z,
        )
    }

    /// F at a point counted from the centre.
    pub fn value(&self, p: DVec3) -> f64 {
        let [.., x, y, z, one] = self.coefficients.map(f64::from);
        (self.half_gradient(p) + DVec3::new(x, y, z)).dot(p) + one
    }
}

impl Shape for Quadric {
    const KIND: &'static str = "quadric";

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let p = point - self.center();
        let gradient = self.half_gradient(p) * 2.0;
        // About how far the surface F = 0 is away, and how far the nearest face.
        let away = self.value(p).abs() / gradient.length().max(f64::MIN_POSITIVE);
        let half = (self.bounds.max.as_dvec3() - self.bounds.min.as_dvec3()) * 0.5;
        let gap = (half - p.abs()).abs();
        let axis = (0..3).min_by(|a, b| gap[*a].total_cmp(&gap[*b])).unwrap_or(0);
        if gap[axis] < away {
            return Some(DVec3::AXES[axis] * p[axis].signum());
        }
        gradient.try_normalize()
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        let moved = |p| super::placed(p, scale, offset);
        let bounds = Aabb { min: moved(self.bounds.min), max: moved(self.bounds.max) };
        // F(p) = 0 where F(q/scale) = 0: multiplied by scale, so that powers of two of either sign stay in range.
        let mut coefficients = self.coefficients;
        for (i, c) in coefficients.iter_mut().enumerate() {
            let degree = if i < 6 {
                1.0 / scale
            } else if i < 9 {
                1.0
            } else {
                scale
            };
            *c = (f64::from(*c) * degree) as f32;
        }
        Self { coefficients, bounds }
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        let corners = self.bounds.min.to_array().into_iter().chain(self.bounds.max.to_array());
        self.coefficients.into_iter().chain(corners).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let fields = Fields(Self::KIND);
        fields.finite("coefficients", &self.coefficients)?;
        fields.finite("min", &self.bounds.min.to_array())?;
        fields.finite("max", &self.bounds.max.to_array())?;
        if self.bounds.is_empty() {
            return fields.refuse("min", "must be below `max`, coordinate by coordinate");
        }
        if self.coefficients[..9] == [0.0; 9] {
            return fields.refuse("coefficients", "must not all be 0 but the last");
        }
        Ok(())
    }
}
