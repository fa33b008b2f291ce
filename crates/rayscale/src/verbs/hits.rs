//! Structures as verbs use them: built, traced.

use crate::console::Console;
use crate::error::Error;
use accel::{Hit, RaySet, Scene, Workload};
use harness::auto;
use harness::record::Query;
use harness::registry::Choice;
use harness::workload::Batch;
use std::time::{Duration, Instant};

/// Hits, and what they took.
#[derive(Debug)]
pub struct Traced {
    /// One for each ray.
    pub hits: Vec<Option<Hit>>,
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
pub fn trace(console: &Console, choice: &Choice, scene: &Scene, rays: &RaySet) -> Result<Traced, Error> {
    console.in_pool(0, || {
        let batch = Batch { rays, query: Query::Closest };
        let choices = auto::resolve(std::slice::from_ref(choice), scene, &[batch]);
        let undecided = choice.is_undecided();
        let choice = &choices[0];
        if undecided {
            console.note(format!("kernel {}: {}", choice.kernel(), choice.reason()));
        }
        let start = Instant::now();
        let accel = choice.builder.build(scene, &Workload::of(rays))?;
        let build = start.elapsed();
        let bytes = rays.len() as u128 * size_of::<Option<Hit>>() as u128;
        let available = accel::available_memory();
        if bytes > available {
            return Err(Error::usage(
                format!("the hits of {} rays take {bytes} bytes; there are {available}", rays.len()),
                "trace fewer rays at a time",
            ));
        }
        let mut hits = vec![None; rays.len()];
        let start = Instant::now();
        accel.trace(rays, &mut hits);
        let trace = start.elapsed();
        Ok(Traced { hits, kernel: choice.kernel(), reason: choice.reason().to_owned(), build, trace })
    })?
}
