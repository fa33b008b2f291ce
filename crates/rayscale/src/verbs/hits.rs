//! Structures as verbs use them: built, traced.

use crate::console::Console;
use crate::error::Error;
use accel::{Accel, Hit, RaySet, Scene, Workload};
use harness::auto;
use harness::record::Query;
use harness::registry::Choice;
use harness::workload::Batch;
use std::time::{Duration, Instant};

/// Hits, and what they took.
#[derive(Debug)]
pub struct Traced<T> {
    /// One for each ray.
    pub hits: Vec<T>,
    /// The structure that found them.
    pub structure: String,
    /// The ray-triangle test that found them.
    pub kernel: &'static str,
    /// Why that one; empty where the user chose.
    pub reason: String,
    /// Time to build the structure.
    pub build: Duration,
    /// Time to trace the rays.
    pub trace: Duration,
}

/// Builds the structure for these rays and traces them, on all cores unless `--threads` says otherwise. A kernel that
/// is left to the suite is decided first.
///
/// # Errors
/// Where the structure can't serve this scene or these rays.
pub fn trace(
    console: &Console,
    choice: &Choice,
    scene: &Scene,
    rays: &RaySet,
) -> Result<Traced<Option<Hit>>, Error> {
    trace_by(console, choice, scene, (rays, Workload::of(rays)), |accel, hits| accel.trace(rays, hits))
}

/// As [`trace`], every crossing of each ray in order.
///
/// # Errors
/// As [`trace`].
pub fn trace_all(
    console: &Console,
    choice: &Choice,
    scene: &Scene,
    rays: &RaySet,
) -> Result<Traced<Vec<Hit>>, Error> {
    trace_by(console, choice, scene, (rays, Workload::GENERAL), |accel, hits| {
        if rays.is_empty() || !accel.candidates(&rays.ray(0), &mut Vec::new()) {
            console.note(format!(
                "{} tells nearest hits only: of crossings at the same t there is one",
                choice.spec
            ));
        }
        accel::for_each_ray(rays, hits, |ray| accel.all_hits(ray));
    })
}

fn trace_by<T: Clone + Default + Send>(
    console: &Console,
    choice: &Choice,
    scene: &Scene,
    (rays, workload): (&RaySet, Workload),
    of: impl Fn(&dyn Accel, &mut [T]) + Sync,
) -> Result<Traced<T>, Error> {
    console.in_pool(0, || {
        let batch = Batch { rays, query: Query::Closest };
        let choices = auto::resolve(std::slice::from_ref(choice), scene, &[batch]);
        let undecided = choice.is_undecided();
        let choice = &choices[0];
        if undecided {
            console.note(format!("kernel {}: {}", choice.kernel(), choice.reason()));
        }
        let start = Instant::now();
        let accel = choice.builder.build(scene, &workload)?;
        let build = start.elapsed();
        let bytes = rays.len() as u128 * size_of::<T>() as u128;
        let available = accel::available_memory();
        if bytes > available {
            return Err(Error::usage(
                format!("the hits of {} rays take {bytes} bytes; there are {available}", rays.len()),
                "trace fewer rays at a time",
            ));
        }
        let mut hits = vec![T::default(); rays.len()];
        let start = Instant::now();
        of(&*accel, &mut hits);
        let trace = start.elapsed();
        let structure = choice.spec.to_string();
        Ok(Traced {
            hits,
            structure,
            kernel: choice.kernel(),
            reason: choice.reason().to_owned(),
            build,
            trace,
        })
    })?
}
