//! Structures as verbs use them: chosen by name, built, traced.

use super::{Console, Error};
use crate::registry::{self, Choice, StructureSpec};
use accel::{Hit, KernelId, Need, RaySet, Scene};
use std::time::{Duration, Instant};

/// The structure of that name and settings, its ray-triangle test being `kernel` if given.
///
/// # Errors
/// Unknown structures, settings and kernels; a kernel for a structure that brings its own, or two.
pub fn choose(text: &str, kernel: Option<&str>) -> Result<Choice, Error> {
    let mut spec: StructureSpec = text.parse()?;
    if let Some(kernel) = kernel {
        let entry = registry::find(&spec.id)?;
        if !entry.traits.own_kernel {
            return Err(Error::usage(
                format!("structure `{}` brings its own ray-triangle test; it takes no --kernel", entry.id),
                "leave --kernel out",
            ));
        }
        let kernel = KernelId::from_id(kernel)
            .ok_or_else(|| Error::unknown("kernel", kernel, KernelId::ALL.map(KernelId::id)))?;
        if spec.get("kernel").is_some_and(|given| given != kernel.id()) {
            return Err(Error::usage(
                format!("`{text}` and --kernel {kernel} name two kernels"),
                "name one of them",
            ));
        }
        spec = spec.with_default("kernel", kernel);
    }
    Ok(registry::choose(&spec)?)
}

/// Hits, and what they took.
#[derive(Debug)]
pub struct Traced {
    /// One for each ray.
    pub hits: Vec<Option<Hit>>,
    /// Time to build the structure.
    pub build: Duration,
    /// Time to trace the rays.
    pub trace: Duration,
}

/// Builds the structure for these rays and traces them, on all cores unless `--threads` says otherwise.
///
/// # Errors
/// Where the structure can't serve this scene or these rays.
pub fn trace(console: &Console, choice: &Choice, scene: &Scene, rays: &RaySet) -> Result<Traced, Error> {
    console.in_pool(0, || {
        let start = Instant::now();
        let accel = choice.builder.build(scene, &Need::of(rays))?;
        let build = start.elapsed();
        let mut hits = vec![None; rays.len()];
        let start = Instant::now();
        accel.trace(rays, &mut hits);
        Ok(Traced { hits, build, trace: start.elapsed() })
    })?
}
