//! Tracing: samples of all structures on one ray set, interleaved.

use super::Options;
use super::deadline::Deadline;
use super::failure::Failure;
use crate::answers::Answers;
use crate::clock::Clock;
use crate::guard::guard;
use crate::record::Query;
use accel::{Accel, RaySet};
use std::time::Duration;

/// A structure under measurement on a ray set.
pub struct Runner<'a> {
    /// The structure.
    pub accel: &'a dyn Accel,
    /// Its rays: the set, or fewer of them.
    pub rays: &'a RaySet,
    /// What is asked of them.
    pub query: Query,
    /// What all samples must answer; where that is not known yet, what the first one answers.
    pub first: Option<Answers>,
    /// Samples in ns, those of earlier passes included.
    pub trace_ns: Vec<u64>,
    /// What went wrong; such a structure is not run again.
    pub failure: Option<Failure>,
}

/// Takes samples round by round, every round beginning with another structure, until as many are there as are due by
/// the end of a pass, or the time of all runners is spent. None if interrupted.
pub fn rounds(runners: &mut [Runner], (options, pass): (&Options, usize), deadline: &Deadline) -> Option<()> {
    let running = || runners.iter().filter(|r| r.failure.is_none());
    let time = options.time_due(options.cell_time, pass) * running().count() as u32;
    let mut spent: Duration = running().flat_map(|r| &r.trace_ns).copied().map(Duration::from_nanos).sum();
    let begun = running().map(|r| r.trace_ns.len()).min().unwrap_or(0);
    for round in begun..options.due(options.rounds, pass) {
        if round >= options.due(options.least_rounds, pass) && spent >= time {
            break;
        }
        for place in 0..runners.len() {
            if deadline.interrupted() {
                return None;
            }
            let i = (place + round) % runners.len();
            spent += sample(&mut runners[i], Clock::of(options.threads));
        }
    }
    Some(())
}

fn sample(runner: &mut Runner, clock: Clock) -> Duration {
    if runner.failure.is_some() {
        return Duration::ZERO;
    }
    let new = || Answers::new(runner.query, runner.rays.len());
    let mut answers = runner.first.clone().unwrap_or_else(new);
    answers.poison();
    let start = clock.now();
    let traced = guard("tracing", || answers.trace(runner.accel, runner.rays));
    let took = clock.now() - start;
    let agreed = traced.map_err(Failure::from).and_then(|()| {
        let first = runner.first.get_or_insert_with(|| answers.clone());
        match answers.first_difference(first) {
            None => Ok(()),
            Some(ray) => Err(Failure::Changed { ray }),
        }
    });
    match agreed {
        Ok(()) => runner.trace_ns.push(took),
        Err(failure) => runner.failure = Some(failure),
    }
    Duration::from_nanos(took)
}
