//! Many scenes, ray sets and structures against brute force.

use super::unavailable;
use crate::answers::Answers;
use crate::check::{Reference, compare};
use crate::guard::guard;
use crate::progress::{Event, Listener};
use crate::record::Query;
use crate::registry::{Choice, guarded_build};
use crate::workload::{self, RayQuery, Subject, batches, in_time, subsample};
use accel::{Accel, RaySet, Scene, Workload};
use primitives::KernelId;
use rayon::prelude::*;
use scenes::{SceneError, SceneSpec};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// What is checked.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Scenes and ray sets.
    pub subject: Subject,
    /// Rays to be compared for each structure, variants counted together: with more
    /// seeds until it is reached. 0 for one pass.
    pub rays_each: u64,
    /// Ray-object tests of brute force for a ray set; where that is not enough for all rays, a sample is
    /// compared.
    pub tests: u64,
}

/// What was found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Tally {
    /// By structure.
    pub structures: Vec<DifferencesRow>,
    /// What differed or failed, in words, the first of each kind.
    pub findings: Vec<String>,
    #[serde(skip)]
    own: Vec<bool>,
    broken: bool,
}

/// A structure's rays and differences.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DifferencesRow {
    /// The structure with its settings.
    pub structure: String,
    /// Rays compared, nearest hits and occlusion counted apart.
    pub rays: u64,
    /// Rays of them that differ.
    pub differences: u64,
}

impl Tally {
    /// Whether no structure of the suite's own differs, and none failed.
    pub fn is_sound(&self) -> bool {
        let own = self.structures.iter().zip(&self.own).filter(|(_, own)| **own);
        !self.broken && own.map(|(row, _)| row.differences).sum::<u64>() == 0
    }

    /// Rays compared of structures with this id, over all settings.
    fn rays_of(&self, choices: &[Choice], id: &str) -> u64 {
        let rows = self.structures.iter().zip(choices).filter(|(_, choice)| choice.entry.id == id);
        rows.map(|(row, _)| row.rays).sum()
    }
}

/// Small scenes that hold the hard cases: all `unit-*`, boxes, and small ones of every character.
pub fn hunting() -> Vec<String> {
    let unit = scenes::list().into_iter().map(|info| info.id).filter(|id| id.starts_with("unit-"));
    let small = ["small-1k", "large-100", "bumps-1k", "boxes-100-40"];
    unit.chain(small.map(str::to_owned).into_iter().filter(|id| scenes::describe(id).is_ok())).collect()
}

/// Checks; `listener` hears of every scene.
///
/// # Errors
/// A scene that is unsound; scenes that are not on this machine are passed over.
pub fn run(sweep: &Sweep, choices: &[Choice], mut listener: impl Listener) -> Result<Tally, SceneError> {
    let mut tally = Tally::default();
    for choice in choices {
        tally
            .structures
            .push(DifferencesRow { structure: choice.spec.to_string(), ..DifferencesRow::default() });
        tally.own.push(choice.entry.traits.built_in);
    }
    let mut pass = 0;
    loop {
        let before: u64 = tally.structures.iter().map(|row| row.rays).sum();
        for id in &sweep.subject.scenes {
            let spec: SceneSpec = id.parse()?;
            match scenes::load(&spec) {
                Ok(scene) => one_scene(sweep, &scene, choices, sweep.subject.seed + pass, &mut tally),
                Err(error) if error.is_unavailable() => tally.findings.push(unavailable(&error)),
                Err(error) => return Err(error),
            }
            if pass == 0 {
                listener.hear(&Event::SceneChecked { id });
            }
        }
        pass += 1;
        let after: u64 = tally.structures.iter().map(|row| row.rays).sum();
        let least = choices.iter().map(|choice| tally.rays_of(choices, choice.entry.id)).min();
        if least.is_none_or(|least| least >= sweep.rays_each) || after == before {
            return Ok(tally);
        }
    }
}

fn one_scene(sweep: &Sweep, scene: &Scene, choices: &[Choice], seed: u64, tally: &mut Tally) {
    let few = (sweep.tests / 16 / scene.geometry.len().max(1) as u64).max(1);
    let few = usize::try_from(few).unwrap_or(usize::MAX);
    // A set that has no rays on this scene (no objects, no hits) is nothing to check.
    let queries = workload::make(scene, &sweep.subject.rays, sweep.subject.size, seed).made;
    let choices = crate::auto::resolve(choices, scene, &batches(&queries));
    let sets: Vec<Set> = queries
        .into_iter()
        .map(|set| Set { subsampled: subsample(&set.rays, few), set, right: Mutex::default() })
        .collect();
    let found: Vec<Found> =
        choices.par_iter().map(|choice| one_choice(sweep, scene, choice, &sets)).collect();
    for (row, found) in tally.structures.iter_mut().zip(&found) {
        row.rays += found.rays;
        row.differences += found.differences;
    }
    for found in found {
        tally.broken |= found.broken;
        found.findings.into_iter().for_each(|text| finding(tally, text));
    }
}

/// A ray set with what brute force answers, computed when first asked for.
struct Set {
    set: RayQuery,
    /// For structures whose time grows with the number of objects.
    subsampled: RaySet,
    right: Mutex<BTreeMap<(KernelId, Query, usize), Arc<Reference>>>,
}

impl Set {
    /// `rays` are the set's or fewer of them.
    fn right(
        &self,
        sweep: &Sweep,
        scene: &Scene,
        rays: &RaySet,
        query: Query,
        kernel: KernelId,
    ) -> Arc<Reference> {
        let key = (kernel, query, rays.len());
        let known = || self.right.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(right) = known().get(&key) {
            return right.clone();
        }
        // Not under the lock: brute force runs in the pool whose threads may wait for it.
        let right = Arc::new(Reference::new(scene, rays, query, kernel, sweep.tests));
        known().insert(key, right.clone());
        right
    }
}

const QUERIES: [Query; 2] = [Query::Closest, Query::Occluded];
/// Time for one structure and set, after which fewer rays of it are traced: a grid of which every cell holds
/// every object would take hours.
const SET_TIME: Duration = Duration::from_millis(250);

/// What one structure showed on one scene.
#[derive(Default)]
struct Found {
    rays: u64,
    differences: u64,
    findings: Vec<String>,
    broken: bool,
}

impl Found {
    fn broken(&mut self, text: String) {
        self.broken = true;
        self.findings.push(text);
    }
}

/// Builds once for every workload that the sets have, and compares.
fn one_choice(sweep: &Sweep, scene: &Scene, choice: &Choice, sets: &[Set]) -> Found {
    let traits = &choice.entry.traits;
    let mut found = Found::default();
    let mut built: Option<(Workload, Box<dyn Accel + '_>)> = None;
    for set in sets {
        let rays = if traits.subsamples(&set.set.rays) { &set.subsampled } else { &set.set.rays };
        let workload = if traits.by_workload { Workload::of(rays) } else { Workload::GENERAL };
        let accel = match built.take().filter(|(known, _)| *known == workload) {
            Some((_, accel)) => accel,
            None => match guarded_build(choice, scene, &workload) {
                Ok(accel) => accel,
                Err(failure) if failure.is_unsupported() => continue,
                Err(failure) => {
                    found.broken(format!("{}: {}: {failure}", choice.spec, scene.id));
                    continue;
                }
            },
        };
        for query in QUERIES {
            let rays = match workload.raster {
                Some(_) => Cow::Borrowed(rays),
                None => in_time(accel.as_ref(), rays, query, SET_TIME),
            };
            let place = format!("{}: {} {} {query:?}", choice.spec, scene.id, set.set.id);
            let right = set.right(sweep, scene, &rays, query, choice.reference_kernel());
            one_set(choice, accel.as_ref(), &rays, &right, query, &place, &mut found);
        }
        built = Some((workload, accel));
    }
    found
}

fn one_set(
    choice: &Choice,
    accel: &dyn Accel,
    rays: &RaySet,
    right: &Reference,
    query: Query,
    place: &str,
    found: &mut Found,
) {
    let mut answers = Answers::new(query, rays.len());
    if let Err(error) = guard("tracing", || answers.trace(accel, rays)) {
        return found.broken(format!("{place}: {error}"));
    }
    let different = compare(&answers, right);
    found.rays += right.numbers.len() as u64;
    found.differences += different.len() as u64;
    if let (true, Some(first)) = (choice.entry.traits.built_in, different.first()) {
        let ray = rays.ray(*first);
        found.findings.push(format!("{place}: {} rays differ, first {first}: {ray:?}", different.len()));
    }
}

/// Findings are shown to people: not thousands of them.
fn finding(tally: &mut Tally, text: String) {
    if tally.findings.len() < 20 && !tally.findings.contains(&text) {
        tally.findings.push(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry;
    use scenes::rays::RaysId;

    fn sweep(ids: &[&str]) -> Tally {
        let choices: Vec<_> = ids.iter().map(|id| registry::parse(id).unwrap()).collect();
        let scenes = vec!["unit-one".into(), "small-100".into()];
        let subject = Subject { scenes, rays: RaysId::ALL.to_vec(), size: 12, seed: 1 };
        let sweep = Sweep { subject, rays_each: 10_000, tests: 100_000_000 };
        run(&sweep, &choices, ()).unwrap()
    }

    #[test]
    fn own_structures_are_sound_and_get_the_rays_asked_for() {
        let tally =
            sweep(&["minmax", "sphere", "ssm", "ssm-list:resolution=4", "bmssm-dense:resolution=3x17x5"]);
        assert!(tally.is_sound(), "{:?}", tally.findings);
        assert!(tally.structures.iter().all(|row| row.rays >= 10_000), "{:?}", tally.structures);
    }

    #[test]
    fn a_structure_that_can_not_be_built_is_no_sound_one() {
        let tally = sweep(&["ssm:resolution=4096"]);
        assert!(!tally.is_sound() && tally.findings[0].contains("ssm"), "{:?}", tally.findings);
    }
}
