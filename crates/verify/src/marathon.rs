//! A long run over random cases, whose record says how far it came, so that it can go on from there.

use crate::cases::{self, Bounds, Reach, WIDE};
use crate::compare::compare;
use accel::Cancel;
use rayon::ThreadPool;
use scenes::Random;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// How far a marathon came.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The program's version and commit.
    pub version: String,
    /// The processor and the instruction sets that cases were run with.
    pub machine: String,
    /// The seed of the first case.
    pub first_seed: u64,
    /// The seed of the case to go on with.
    pub next_seed: u64,
    /// Cases whose scenes were refused by name, which is right for what they hold.
    pub refused: u64,
    /// Rays compared with brute force, bit for bit; once for each structure that they were traced through.
    pub rays: u64,
    /// Those that hit.
    pub hits: u64,
    /// Those that were compared with the oracle as well.
    pub exact: u64,
    /// Rays by structure and kernel.
    pub by_structure: BTreeMap<String, u64>,
    /// Rays by instruction set; `default` is the machine's best.
    pub by_level: BTreeMap<String, u64>,
    /// Rays by number of threads.
    pub by_threads: BTreeMap<usize, u64>,
    /// What the cases went through.
    pub covered: Option<Bounds>,
    /// What was found, with the seeds.
    pub differences: Vec<String>,
    /// Seconds spent.
    pub seconds: f64,
}

impl Record {
    /// Nothing done yet.
    pub fn new(version: String, machine: String, first_seed: u64) -> Self {
        Self { version, machine, first_seed, next_seed: first_seed, ..Self::default() }
    }

    fn cover(&mut self, reach: &Reach) {
        let offset = reach.offset.unwrap_or(0);
        let Reach { scale, origins, .. } = *reach;
        let now = self.covered.unwrap_or(Bounds { scale: [scale; 2], offset, origins });
        self.covered = Some(Bounds {
            scale: [now.scale[0].min(scale), now.scale[1].max(scale)],
            offset: now.offset.max(offset),
            origins: now.origins.max(origins),
        });
    }
}

/// Triangles of a case at most, rays of a case, and those that the oracle sees.
const TRIANGLES: u32 = 200;
const RAYS: usize = 4096;
const EXACT: usize = 64;
/// Structures that trace a case's rays.
const STRUCTURES: usize = 3;
/// Pools of so many threads take turns.
const THREADS: [usize; 3] = [1, 2, 5];
/// Differences that are kept.
const MOST: usize = 100;

/// When a marathon ends, besides being cancelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// At so many rays in the record.
    pub rays: u64,
    /// After so long.
    pub time: Option<Duration>,
}

/// Goes on with `record` to the goal; `keep` gets it every few seconds and in the end.
///
/// # Errors
/// Threads that the system does not give, and what `keep` answers.
pub fn run<E>(
    record: &mut Record,
    goal: Goal,
    cancel: Cancel,
    mut keep: impl FnMut(&Record) -> Result<(), E>,
) -> Result<(), E>
where
    E: From<rayon::ThreadPoolBuildError>,
{
    const EVERY: Duration = Duration::from_secs(5);
    let pool = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools: Vec<ThreadPool> = THREADS.into_iter().map(pool).collect::<Result<_, _>>()?;
    let (start, before) = (Instant::now(), record.seconds);
    let mut kept = Instant::now();
    while record.rays < goal.rays && goal.time.is_none_or(|time| start.elapsed() < time) && !cancel.is_asked()
    {
        let seed = record.next_seed;
        one_case(record, seed, &pools[seed as usize % pools.len()]);
        record.next_seed += 1;
        record.seconds = before + start.elapsed().as_secs_f64();
        if kept.elapsed() >= EVERY {
            keep(record)?;
            kept = Instant::now();
        }
    }
    keep(record)
}

fn one_case(record: &mut Record, seed: u64, pool: &ThreadPool) {
    let mut numbers = Random::new(seed);
    let reach = Reach::new(&mut numbers, &WIDE);
    let Ok(scene) = cases::scene(&mut numbers, &reach, TRIANGLES) else {
        record.refused += 1;
        return;
    };
    record.cover(&reach);
    let rays = cases::rays(&mut numbers, &scene, &reach, RAYS);
    for _ in 0..STRUCTURES {
        let spec = cases::structure(&mut numbers);
        match pool.install(|| compare(&scene, &rays, &spec, EXACT)) {
            Ok(compared) => {
                record.rays += compared.rays;
                record.hits += compared.hits;
                record.exact += compared.exact;
                let plain: Vec<&str> = spec.split(',').collect();
                *record.by_structure.entry(plain[0].to_owned()).or_default() += compared.rays;
                let level = plain.iter().find_map(|part| part.strip_prefix("simd=")).unwrap_or("default");
                *record.by_level.entry(level.to_owned()).or_default() += compared.rays;
                *record.by_threads.entry(pool.current_num_threads()).or_default() += compared.rays;
            }
            Err(difference) if record.differences.len() < MOST => {
                record.differences.push(format!("seed {seed}, {reach:?}: {difference}"));
            }
            Err(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, thiserror::Error)]
    #[error(transparent)]
    struct Threads(#[from] rayon::ThreadPoolBuildError);

    fn run_to(record: &mut Record, rays: u64) {
        let goal = Goal { rays, time: None };
        run(record, goal, Cancel::NEVER, |_| Ok::<_, Threads>(())).unwrap();
    }

    #[test]
    fn a_run_in_two_parts_is_the_run_in_one() {
        let (mut parts, mut whole) = (Record::default(), Record::default());
        run_to(&mut parts, 100_000);
        assert!(parts.rays >= 100_000 && parts.differences.is_empty(), "{:#?}", parts.differences);
        run_to(&mut parts, 300_000);
        run_to(&mut whole, 300_000);
        assert!(whole.exact > 0 && whole.hits > 10_000);
        assert_eq!(Record { seconds: 0.0, ..parts }, Record { seconds: 0.0, ..whole });
    }

    #[test]
    fn a_cancelled_run_keeps_what_it_has() {
        let mut kept = 0;
        let mut record = Record::default();
        let keep = |_: &Record| {
            kept += 1;
            Ok::<_, Threads>(())
        };
        run(&mut record, Goal { rays: u64::MAX, time: None }, Cancel::when(&|| true), keep).unwrap();
        assert_eq!((kept, record), (1, Record::default()));
    }
}
