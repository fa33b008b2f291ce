//! A scene's bounds and coordinate frames, in double precision.

use crate::random::Random;
use accel::{Aabb, Scene};
use glam::DVec3;
use std::f64::consts::TAU;

/// Where a scene is and how big.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Lower corner of the bounds.
    pub min: DVec3,
    /// Upper corner of the bounds.
    pub max: DVec3,
    /// Half the diagonal; for a scene of one point a small number.
    pub radius: f64,
}

impl Frame {
    /// The scene's bounds; the unit cube for an empty scene.
    pub fn of(scene: &Scene) -> Self {
        Self::around(&scene.geometry.bounds())
    }

    /// The frame of `bounds`; the unit cube for empty bounds.
    pub fn around(bounds: &Aabb) -> Self {
        let (min, max) = match bounds.is_empty() {
            true => (DVec3::ZERO, DVec3::ONE),
            false => (bounds.min.as_dvec3(), bounds.max.as_dvec3()),
        };
        let least = (min.abs().max(max.abs()).max_element() * 1e-6).max(1e-36);
        Self { min, max, radius: (0.5 * (max - min).length()).max(least) }
    }

    /// The middle of the bounds.
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// A point uniform in the bounds.
    pub fn point(&self, random: &mut Random) -> DVec3 {
        self.min + (self.max - self.min) * random.in_cube(0.0, 1.0)
    }

    /// A point on the sphere of `scale` times the bounds' radius around their middle.
    pub fn around_point(&self, random: &mut Random, scale: f64) -> DVec3 {
        self.center() + random.direction() * (self.radius * scale)
    }

    /// A coordinate of one of the planes that divide axis `axis` into `slices` slices, as single precision
    /// computes it from single-precision bounds.
    pub fn slice_plane(&self, random: &mut Random, axis: usize, slices: usize) -> f64 {
        let (low, high) = (self.min[axis] as f32, self.max[axis] as f32);
        let k = random.below(slices + 1) as f32;
        f64::from(low + (high - low) * (k / slices as f32))
    }
}

/// A direction of the hemisphere about the unit vector `normal`, its density proportional to the cosine.
pub fn cosine_direction(random: &mut Random, normal: DVec3) -> DVec3 {
    let (x, y) = normal.any_orthonormal_pair();
    let square = random.unit();
    let (sin, cos) = libm::sincos(TAU * random.unit());
    let radius = square.sqrt();
    (x * (radius * cos) + y * (radius * sin) + normal * (1.0 - square).sqrt()).normalize()
}
