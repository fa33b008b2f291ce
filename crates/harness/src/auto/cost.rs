//! What kernels cost in a structure on a scene's rays.

use crate::answers::Answers;
use crate::clock::Clock;
use crate::guard::guard;
use crate::registry::{Choice, guarded_build};
use crate::stats::geometric_mean;
use crate::workload::{Batch, in_time, subsample};
use accel::{Scene, Workload};
use primitives::KernelId;
use std::time::Duration;

/// Rays of a batch that are timed, at most.
const MAX_RAYS: usize = 1 << 14;

/// Times that every kernel is timed; the least counts, for whatever disturbs makes it longer.
const ROUNDS: usize = 5;

/// Time for one round of a kernel and batch, about, after which fewer rays are timed.
const ROUND_TIME: Duration = Duration::from_millis(50);

/// ns per ray of each kernel in the structure, the geometric mean over the batches, samples taken in turns; `None` where it
/// can't be built or traced.
pub fn costs(choice: &Choice, scene: &Scene, batches: &[Batch], kernels: &[KernelId]) -> Vec<Option<f64>> {
    let choices: Vec<Choice> = kernels.iter().map(|kernel| choice.decided(*kernel, String::new())).collect();
    let mut all = vec![Some(Vec::new()); kernels.len()];
    for batch in batches {
        for (sum, ns) in all.iter_mut().zip(batch_costs(&choices, scene, batch)) {
            match (&mut *sum, ns) {
                (Some(sum), Some(ns)) => sum.push(ns),
                _ => *sum = None,
            }
        }
    }
    all.into_iter().map(|ns| geometric_mean(&ns?)).collect()
}

fn batch_costs(choices: &[Choice], scene: &Scene, batch: &Batch) -> Vec<Option<f64>> {
    let traits = &choices[0].entry.traits;
    let mut rays = subsample(batch.rays, MAX_RAYS);
    let workload = if traits.by_workload { Workload::of(&rays) } else { Workload::GENERAL };
    let built: Vec<_> = choices.iter().map(|choice| guarded_build(choice, scene, &workload).ok()).collect();
    if let Some(accel) = built.iter().flatten().next().filter(|_| workload.raster.is_none()) {
        rays = in_time(accel.as_ref(), &rays, batch.query, ROUND_TIME).into_owned();
    }
    let clock = Clock::of(rayon::current_num_threads());
    let mut answers = Answers::new(batch.query, rays.len());
    let mut least = vec![None; choices.len()];
    for _ in 0..ROUNDS {
        for (accel, least) in built.iter().zip(&mut least) {
            let Some(accel) = accel else { continue };
            let start = clock.now();
            if guard("tracing", || answers.trace(accel.as_ref(), &rays)).is_err() {
                continue;
            }
            // A clock may not tell two instants apart.
            let ns = (clock.now() - start).max(1) as f64 / rays.len().max(1) as f64;
            *least = Some(least.map_or(ns, |known: f64| known.min(ns)));
        }
    }
    least
}
