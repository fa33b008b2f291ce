//! Ray sets: what is asked of a scene's structure.
//!
//! A set follows from the scene, its name, its size and a seed. `shadow`, `ambient`,
//! `diffuse` and two of the stress sets start from hits: they also need something that
//! answers closest-hit rays, any [`Accel`] built with [`Workload::GENERAL`](accel::Workload::GENERAL).
//!
//! ```
//! use accel::{Builder, Workload};
//! use baselines::Brute;
//! use primitives::KernelId;
//! use scenes::rays::{RaysId, RaysSpec, generate};
//!
//! let scene = scenes::load(&"unit-flat".parse()?)?;
//! let brute = Brute::new(KernelId::MollerTrumbore).build(&scene, &Workload::GENERAL)?;
//! let spec = RaysSpec { id: RaysId::Diffuse, rows: 8, cols: 8, seed: 1 };
//! assert_eq!(generate(&scene, &spec, brute.as_ref())?.len(), 64);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod features;
mod frame;
mod id;
mod lines;
mod raster;
mod spawn;
mod spec;
mod stress;
#[cfg(test)]
mod tests;

pub use id::{Feature, Kind, Query, RaysError, RaysId};
pub use raster::{parallel, perspective};
pub use spawn::offset as spawn_offset;
pub use spec::RaysSpec;

use accel::input::check_ray;
use accel::{Accel, RaySet, Scene};

/// Makes the rays. `tracer` answers closest hits of the scene, where [`RaysId::needs_hits`];
/// its answers are part of what the set depends on.
///
/// # Errors
/// [`RaysError::TooLarge`] where memory doesn't suffice, [`RaysError::NoHits`] where rays start from hits and the view meets nothing,
/// [`RaysError::NoObjects`] where they aim at objects and there is none, [`RaysError::Unusable`] where
/// one of them is no ray that structures accept.
///
/// # Panics
/// If `tracer` serves general rays no better than to panic.
pub fn generate(scene: &Scene, spec: &RaysSpec, tracer: &dyn Accel) -> Result<RaySet, RaysError> {
    let RaysSpec { id, rows, cols, .. } = *spec;
    spec.check_memory()?;
    let list = match id {
        RaysId::Parallel => {
            let raster = parallel(&scene.view, &scene.geometry.bounds(), rows, cols);
            return checked(scene, id, RaySet::Raster(raster));
        }
        RaysId::Perspective => {
            return checked(scene, id, RaySet::Raster(perspective(&scene.view, rows, cols)));
        }
        RaysId::Shadow | RaysId::Ambient | RaysId::Diffuse => spawn::from_hits(scene, spec, tracer)?,
        RaysId::Random => lines::random(scene, spec),
        RaysId::Axis => lines::axis(scene, spec),
        _ => stress::rays(scene, spec, tracer)?,
    };
    checked(scene, id, RaySet::List(list))
}

/// The set, if structures accept all its rays.
fn checked(scene: &Scene, id: RaysId, rays: RaySet) -> Result<RaySet, RaysError> {
    let bounds = scene.geometry.bounds();
    for i in 0..rays.len() {
        if let Err(source) = check_ray(&bounds, &rays.ray(i)) {
            return Err(RaysError::Unusable { rays: id, scene: scene.id.clone(), source });
        }
    }
    Ok(rays)
}
