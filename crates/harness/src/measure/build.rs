//! Building: memory from one build, times from others.

use super::Options;
use super::deadline::Deadline;
use crate::clock::Clock;
use crate::record::Bytes;
use crate::registry::{BuildFailure, Choice, guarded_build_unless};
use accel::{Accel, Cancel, Group, Scene, Workload};
use heap;

/// A structure on its way through a scene.
pub struct Built<'s> {
    /// The structure, or why there is none.
    pub accel: Result<Box<dyn Accel + 's>, Absent>,
    /// Build times in ns.
    pub build_ns: Vec<u64>,
    /// Memory.
    pub bytes: Option<Bytes>,
}

/// Why there is no structure.
#[derive(Clone, Debug, PartialEq)]
pub enum Absent {
    /// Its memory is in use elsewhere until the next pass.
    Dropped,
    /// It can't be built.
    Failed(BuildFailure),
}

impl Built<'_> {
    /// Frees the structure's memory; the next pass builds it anew.
    pub fn drop_structure(&mut self) {
        if self.accel.is_ok() {
            self.accel = Err(Absent::Dropped);
        }
    }
}

/// Builds every choice for its workload: in the first pass (when `all` is empty) once watched for memory, then round by
/// round for time, as many times as are due by the end of that pass.
///
/// None if interrupted or out of time: nothing would begin with what was built.
pub fn build_all<'s>(
    scene: &'s Scene,
    wanted: &[(&Choice, Workload)],
    (options, pass): (&Options, usize),
    deadline: &Deadline,
    all: &mut Vec<Built<'s>>,
) -> Option<()> {
    for (choice, workload) in &wanted[all.len()..] {
        if deadline.is_over() {
            return None;
        }
        all.push(watched(scene, choice, workload, deadline));
        if deadline.is_over() {
            return None;
        }
    }
    for round in 0..options.due(options.build_rounds, pass) {
        for place in 0..wanted.len() {
            if deadline.is_over() {
                return None;
            }
            let i = (place + round) % wanted.len();
            let (choice, workload) = &wanted[i];
            let built = &mut all[i];
            let (count, spent) = (built.build_ns.len(), built.build_ns.iter().sum::<u64>());
            let in_time = u128::from(spent) < options.time_due(options.build_time, pass).as_nanos();
            let least = options.least_builds.min(options.build_rounds);
            let more = count < options.due(least, pass)
                || in_time && count < options.due(options.build_rounds, pass);
            let wants = match built.accel {
                Ok(_) => more,
                Err(Absent::Dropped) => true,
                Err(Absent::Failed(_)) => false,
            };
            if wants {
                timed(scene, choice, workload, Clock::of(options.threads), deadline, built);
                if deadline.is_over() {
                    return None;
                }
            }
        }
    }
    Some(())
}

fn watched<'s>(scene: &'s Scene, choice: &Choice, workload: &Workload, deadline: &Deadline) -> Built<'s> {
    let over = || deadline.is_over();
    let build = || guarded_build_unless(choice, scene, workload, Cancel::when(&over));
    let (accel, used) = heap::observe(build);
    let used = used.filter(|_| choice.entry.traits.counted);
    let bytes = accel.as_ref().ok().map(|accel| {
        let footprint = accel.footprint();
        let mut bytes = Bytes {
            structure: footprint.bytes(Group::Structure) as u64,
            geometry_copy: footprint.bytes(Group::GeometryCopy) as u64,
            peak_build: used.map(|used| used.peak),
            allocated: used.map(|used| used.left.max(0) as u64),
            parts: Default::default(),
        };
        for part in footprint.parts {
            *bytes.parts.entry(part.name.to_owned()).or_default() += part.bytes as u64;
        }
        bytes
    });
    Built { accel: accel.map_err(Absent::Failed), build_ns: Vec::new(), bytes }
}

fn timed<'s>(
    scene: &'s Scene,
    choice: &Choice,
    workload: &Workload,
    clock: Clock,
    deadline: &Deadline,
    built: &mut Built<'s>,
) {
    let over = || deadline.is_over();
    let start = clock.now_of_build();
    let again = guarded_build_unless(choice, scene, workload, Cancel::when(&over));
    let ns = clock.now_of_build() - start;
    if again.is_ok() {
        built.build_ns.push(ns);
    }
    // Dropping the former structure is not part of building the new one.
    built.accel = again.map_err(Absent::Failed);
}
