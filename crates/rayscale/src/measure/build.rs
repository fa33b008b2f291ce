//! Building: memory from one build, times from others.

use super::Options;
use super::guard::guard;
use super::watch::Watch;
use crate::clock::Clock;
use crate::heap;
use crate::record::Bytes;
use crate::registry::Choice;
use accel::{Accel, Group, Need, Scene};

/// A structure on its way through a scene, or the reason why it has none.
pub struct Built<'s> {
    /// The structure, and what it needs to be built again.
    pub accel: Result<Box<dyn Accel + 's>, String>,
    /// Build times in ns.
    pub build_ns: Vec<u64>,
    /// Memory.
    pub bytes: Option<Bytes>,
}

/// Builds every choice for its need: once watched for memory, then round by round for time.
///
/// None if interrupted.
pub fn build_all<'s>(
    scene: &'s Scene,
    wanted: &[(&Choice, Need)],
    options: &Options,
    watch: &Watch,
) -> Option<Vec<Built<'s>>> {
    let mut all = Vec::new();
    for (choice, need) in wanted {
        if watch.interrupted() {
            return None;
        }
        all.push(watched(scene, choice, need));
    }
    for round in 0..options.build_rounds {
        for place in 0..wanted.len() {
            if watch.interrupted() {
                return None;
            }
            let i = (place + round) % wanted.len();
            let (choice, need) = &wanted[i];
            let built = &mut all[i];
            let spent: u64 = built.build_ns.iter().sum();
            let more = round < options.least_builds || u128::from(spent) < options.build_time.as_nanos();
            if built.accel.is_ok() && more {
                timed(scene, choice, need, Clock::of(options.threads), built);
            }
        }
    }
    Some(all)
}

/// Builds; what the builder refuses and what it panics with are both told in words.
pub fn guarded_build<'s>(
    choice: &Choice,
    scene: &'s Scene,
    need: &Need,
) -> Result<Box<dyn Accel + 's>, String> {
    guard("the build", || choice.builder.build(scene, need))
        .and_then(|built| built.map_err(|e| e.to_string()))
}

fn watched<'s>(scene: &'s Scene, choice: &Choice, need: &Need) -> Built<'s> {
    let (accel, used) = heap::observe(|| guarded_build(choice, scene, need));
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
    Built { accel, build_ns: Vec::new(), bytes }
}

fn timed<'s>(scene: &'s Scene, choice: &Choice, need: &Need, clock: Clock, built: &mut Built<'s>) {
    let start = clock.now_of_build();
    let again = guarded_build(choice, scene, need);
    let ns = clock.now_of_build() - start;
    if again.is_ok() {
        built.build_ns.push(ns);
    }
    // Dropping the former structure is not part of building the new one.
    built.accel = again;
}
