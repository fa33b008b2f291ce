//! A structure that may be asked anything.

use crate::input::traceable;
use crate::{Accel, Footprint, Hit, Ray, RaySet};
use std::fmt;

/// A scene that any ray can be traced through: what a built structure answers.
///
/// Of several hits at the same t the lowest object number wins. A ray that is none, because it isn't finite or has no
/// direction ([`Ray::validate`]), hits nothing.
pub struct AnyRays<'s>(Box<dyn Accel + 's>);

impl<'s> AnyRays<'s> {
    /// Of a structure that was built for rays of any kind.
    pub fn new(built: Box<dyn Accel + 's>) -> Self {
        Self(built)
    }

    /// The nearest hit.
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        ray.validate().is_ok().then(|| self.0.closest(ray)).flatten()
    }

    /// Whether anything is hit.
    pub fn occluded(&self, ray: &Ray) -> bool {
        ray.validate().is_ok() && self.0.occluded(ray)
    }

    /// The nearest hit of each ray. Faster than ray by ray; with the feature `parallel` on all threads of the
    /// current rayon pool.
    pub fn trace(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        let mut hits = vec![None; rays.len()];
        self.0.trace(&RaySet::List(traceable(rays).into_owned()), &mut hits);
        hits
    }

    /// Whether each ray hits anything, see [`AnyRays::trace`].
    pub fn trace_occluded(&self, rays: &[Ray]) -> Vec<bool> {
        let mut occluded = vec![false; rays.len()];
        self.0.trace_occluded(&RaySet::List(traceable(rays).into_owned()), &mut occluded);
        occluded
    }

    /// Every crossing in order, see [`Accel::all_hits`].
    pub fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        if ray.validate().is_ok() { self.0.all_hits(ray) } else { Vec::new() }
    }

    /// What the structure holds in memory, part by part, beside the caller's own buffers.
    pub fn footprint(&self) -> Footprint {
        self.0.footprint()
    }
}

impl fmt::Debug for AnyRays<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("AnyRays").field("footprint", &self.footprint()).finish()
    }
}
