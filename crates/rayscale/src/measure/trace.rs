//! Tracing: samples of all structures on one ray set, interleaved.

use super::Options;
use super::guard::guard;
use super::watch::Watch;
use crate::answers::Answers;
use crate::clock::Clock;
use accel::{Accel, RaySet};
use std::time::Duration;

/// A structure under measurement on a ray set.
pub struct Runner<'a> {
    /// The structure.
    pub accel: &'a dyn Accel,
    /// Its rays: the set, or fewer of them.
    pub rays: &'a RaySet,
    /// The answers of the warm-up, which have been checked.
    pub first: Answers,
    /// Samples in ns.
    pub trace_ns: Vec<u64>,
    /// What went wrong; such a structure is not run again.
    pub error: Option<String>,
}

/// Takes samples round by round, every round beginning with another structure, until there are
/// `options.rounds` of them or the time of all runners is spent. None if interrupted.
pub fn rounds(runners: &mut [Runner], options: &Options, watch: &Watch) -> Option<()> {
    let running = runners.iter().filter(|r| r.error.is_none()).count() as u32;
    let time = options.cell_time * running;
    let mut spent = Duration::ZERO;
    for round in 0..options.rounds {
        if round >= options.least_rounds && spent >= time {
            break;
        }
        for place in 0..runners.len() {
            if watch.interrupted() {
                return None;
            }
            let i = (place + round) % runners.len();
            spent += sample(&mut runners[i], Clock::of(options.threads));
        }
    }
    Some(())
}

fn sample(runner: &mut Runner, clock: Clock) -> Duration {
    if runner.error.is_some() {
        return Duration::ZERO;
    }
    let mut answers = runner.first.clone();
    answers.spoil();
    let start = clock.now();
    let traced = guard("tracing", || answers.trace(runner.accel, runner.rays));
    let took = clock.now() - start;
    let agreed = traced.and_then(|()| match answers.first_difference(&runner.first) {
        None => Ok(()),
        Some(i) => Err(format!("ray {i} of a timed trace has another answer than in the checked trace")),
    });
    match agreed {
        Ok(()) => runner.trace_ns.push(took),
        Err(error) => runner.error = Some(error),
    }
    Duration::from_nanos(took)
}
