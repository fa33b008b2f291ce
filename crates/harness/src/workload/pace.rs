//! Fewer rays for structures that would take too long.

use super::subsample;
use crate::answers::Answers;
use crate::clock::Clock;
use crate::guard::{Panicked, guard};
use crate::record::Query;
use accel::{Accel, RaySet};
use std::borrow::Cow;
use std::time::Duration;

/// Rays that a structure is judged by.
const FEW: usize = 64;

/// The rays of a set that a structure can trace in about that time: all of them, or a quarter, a sixteenth,
/// …, so that the number seldom differs from run to run. Judged by the faster of two runs of a few rays.
///
/// A structure that was built for one raster can't be asked for fewer of its rays.
pub fn in_time<'a>(accel: &dyn Accel, rays: &'a RaySet, query: Query, time: Duration) -> Cow<'a, RaySet> {
    let few = subsample(rays, FEW);
    let mut answers = Answers::new(query, few.len());
    let clock = Clock::of(rayon::current_num_threads());
    let run = || {
        let start = clock.now();
        guard("tracing", || answers.trace(accel, &few)).map(|()| Duration::from_nanos(clock.now() - start))
    };
    let runs: Result<Vec<Duration>, Panicked> = std::iter::repeat_with(run).take(2).collect();
    // A structure that panics is found out where its answers are asked for.
    let Some(least) = runs.ok().and_then(|runs| runs.into_iter().min()) else {
        return Cow::Borrowed(rays);
    };
    let each = (least.as_secs_f64() / few.len().max(1) as f64).max(1e-10);
    let mut fit = rays.len();
    while fit > FEW && fit as f64 * each > time.as_secs_f64() {
        fit = fit.div_ceil(4);
    }
    if fit == rays.len() { Cow::Borrowed(rays) } else { Cow::Owned(subsample(rays, fit)) }
}
