//! A long run over random cases, whose record says how far it came, so that it can go on from there.

mod case;

use crate::cases::{Bounds, Reach};
use accel::Cancel;
use case::{Case, Size};
use rayon::{ThreadPool, ThreadPoolBuildError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
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
    /// Cases whose scenes or all of whose rays were refused by name, which is right for what they hold.
    pub refused: u64,
    /// Rays compared with brute force, bit for bit; once for each structure that they were traced through.
    pub rays: u64,
    /// Those that hit.
    pub hits: u64,
    /// Answers of brute force with the exact kernel, which structures were held to, that were compared with the oracle.
    pub exact: u64,
    /// Rays by structure and kernel.
    pub by_structure: BTreeMap<String, u64>,
    /// Rays by instruction set; `default` is the machine's best.
    pub by_level: BTreeMap<String, u64>,
    /// Rays by number of threads.
    pub by_threads: BTreeMap<usize, u64>,
    /// Rays by the shape of the scene.
    pub by_shape: BTreeMap<String, u64>,
    /// Rays of lists, of images where nothing else is wanted, and of images beside lists.
    pub by_rays: BTreeMap<String, u64>,
    /// Rays by the number of objects: up to so many, a power of two.
    pub by_objects: BTreeMap<u64, u64>,
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

    /// Adds what a case found.
    fn add(&mut self, case: Case) {
        self.next_seed += 1;
        self.refused += u64::from(case.refused);
        self.exact += case.exact;
        self.hits += case.hits;
        let room = MAX.saturating_sub(self.differences.len());
        self.differences.extend(case.differences.into_iter().take(room));
        for held in case.held {
            self.rays += held.rays;
            *self.by_structure.entry(held.structure).or_default() += held.rays;
            *self.by_level.entry(held.level).or_default() += held.rays;
            *self.by_threads.entry(case.threads).or_default() += held.rays;
            *self.by_shape.entry(case.shape.clone()).or_default() += held.rays;
            *self.by_rays.entry(case.kind.clone()).or_default() += held.rays;
            *self.by_objects.entry(case.objects.next_power_of_two()).or_default() += held.rays;
        }
        if let Some(reach) = case.reach {
            self.cover(&reach);
        }
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

/// Pools of so many threads take turns.
const THREADS: [usize; 3] = [1, 2, 5];
/// Cases that are done between two looks at the goal, whatever the machine, so that runs in parts are the run in one.
const TOGETHER: usize = 16;
/// Differences that are kept.
const MAX: usize = 100;

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
pub fn run<E: From<ThreadPoolBuildError>>(
    record: &mut Record,
    goal: Goal,
    cancel: Cancel,
    keep: impl FnMut(&Record) -> Result<(), E>,
) -> Result<(), E> {
    run_sized(record, goal, cancel, Size::USUAL, keep)
}

fn run_sized<E: From<ThreadPoolBuildError>>(
    record: &mut Record,
    goal: Goal,
    cancel: Cancel,
    size: Size,
    mut keep: impl FnMut(&Record) -> Result<(), E>,
) -> Result<(), E> {
    const EVERY: Duration = Duration::from_secs(5);
    let workers: Vec<Pools> = (0..std::thread::available_parallelism().map_or(1, usize::from))
        .map(|_| pools())
        .collect::<Result<_, _>>()?;
    let (start, before) = (Instant::now(), record.seconds);
    let mut kept = Instant::now();
    while record.rays < goal.rays && goal.time.is_none_or(|time| start.elapsed() < time) && !cancel.is_asked()
    {
        for case in together(record.next_seed, &workers, size) {
            record.add(case);
        }
        record.seconds = before + start.elapsed().as_secs_f64();
        if kept.elapsed() >= EVERY {
            keep(record)?;
            kept = Instant::now();
        }
    }
    keep(record)
}

/// One of each number of threads.
type Pools = Vec<ThreadPool>;

fn pools() -> Result<Pools, ThreadPoolBuildError> {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    THREADS.into_iter().map(pool).collect()
}

/// The next cases, in order; each worker takes the next that nobody has.
fn together(first: u64, workers: &[Pools], size: Size) -> Vec<Case> {
    let next = AtomicUsize::new(0);
    let work = |pools: &Pools| {
        let mut done = Vec::new();
        loop {
            let place = next.fetch_add(1, Relaxed);
            if place >= TOGETHER {
                return done;
            }
            let seed = first + place as u64;
            let pool = &pools[seed as usize % pools.len()];
            done.push((place, pool.install(|| Case::run(seed, size))));
        }
    };
    let mut cases: Vec<(usize, Case)> = std::thread::scope(|scope| {
        let workers: Vec<_> = workers.iter().map(|pools| scope.spawn(|| work(pools))).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("cases catch what panics")).collect()
    });
    cases.sort_by_key(|(place, _)| *place);
    cases.into_iter().map(|(_, case)| case).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, thiserror::Error)]
    #[error(transparent)]
    struct Threads(#[from] rayon::ThreadPoolBuildError);

    const SMALL: Size = Size { rays: 1024, structures: 3, exact: 32, largest: 1000 };

    fn run_to(record: &mut Record, rays: u64) {
        let goal = Goal { rays, time: None };
        run_sized(record, goal, Cancel::NEVER, SMALL, |_| Ok::<_, Threads>(())).unwrap();
    }

    #[test]
    fn a_run_in_two_parts_is_the_run_in_one() {
        let (mut parts, mut whole) = (Record::default(), Record::default());
        run_to(&mut parts, 60_000);
        assert!(parts.rays >= 60_000 && parts.differences.is_empty(), "{:#?}", parts.differences);
        run_to(&mut parts, 200_000);
        run_to(&mut whole, 200_000);
        assert!(whole.exact > 0 && whole.hits > 10_000);
        assert!(["list", "image", "both"].iter().all(|kind| whole.by_rays.contains_key(*kind)));
        assert!(whole.by_shape.len() > crate::cases::SHAPES.len() / 2, "{:?}", whole.by_shape);
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
