//! Solids of any kind.

use crate::{Crossing, Crossings};
use accel::{Ray, Solid, Surface};

/// Calls a method of [`Crossings`] for whatever kind there is.
macro_rules! of_kind {
    ($solid:expr, $shape:ident => $does:expr) => {
        match $solid {
            Solid::Triangle($shape) => $does,
            Solid::Box($shape) => $does,
            Solid::Sphere($shape) => $does,
            Solid::Cone($shape) => $does,
            Solid::Disc($shape) => $does,
            Solid::Quadric($shape) => $does,
            Solid::Torus($shape) => $does,
            Solid::Implicit($shape) => $does,
            Solid::Patch($shape) => $does,
            Solid::Facets($shape) => $does,
            Solid::Csg($shape) => $does,
        }
    };
}

impl Crossings for Solid {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        of_kind!(self, shape => shape.crossings(ray, out));
    }

    fn nearest(&self, ray: &Ray, t_max: f32) -> Option<Surface> {
        of_kind!(self, shape => shape.nearest(ray, t_max))
    }
}
