//! Solids of any kind.

use crate::{Crossing, Crossings};
use accel::{Ray, Solid, Surface, of_solid};

impl Crossings for Solid {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        of_solid!(self, shape => shape.crossings(ray, out));
    }

    fn nearest(&self, ray: &Ray, t_max: f32) -> Option<Surface> {
        of_solid!(self, shape => shape.nearest(ray, t_max))
    }
}
