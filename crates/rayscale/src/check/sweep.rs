//! Many scenes, ray sets and structures against brute force.

use super::{Reference, compare};
use crate::answers::Answers;
use crate::measure::{Options, Session, guard, workloads};
use crate::rays::RaysId;
use crate::rayset::thin;
use crate::record::Query;
use crate::registry::Choice;
use crate::scene::{self, SceneError, SceneSpec};
use accel::{Accel, BuildError, KernelId, Need, RaySet, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// What is checked.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Scenes by name.
    pub scenes: Vec<String>,
    /// Ray sets.
    pub rays: Vec<RaysId>,
    /// Rows and columns of rasters; lists have as many rays.
    pub size: u32,
    /// Seed of lists.
    pub seed: u64,
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
    pub structures: Vec<Row>,
    /// What differed or failed, in words, the first of each kind.
    pub findings: Vec<String>,
    #[serde(skip)]
    own: Vec<bool>,
    broken: bool,
}

/// A structure's rays and differences.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Row {
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
    let unit = scene::list().into_iter().map(|info| info.id).filter(|id| id.starts_with("unit-"));
    let small = ["small-1k", "large-100", "bumps-1k", "boxes-100-40"];
    unit.chain(small.map(str::to_owned).into_iter().filter(|id| scene::describe(id).is_ok())).collect()
}

/// Checks; `tell` gets a line for every scene.
///
/// # Errors
/// A scene that is unsound; scenes that are not on this machine are passed over.
pub fn run(sweep: &Sweep, choices: &[Choice], mut tell: impl FnMut(&str)) -> Result<Tally, SceneError> {
    let mut tally = Tally::default();
    for choice in choices {
        tally.structures.push(Row { structure: choice.spec.to_string(), ..Row::default() });
        tally.own.push(choice.entry.traits.own_kernel);
    }
    let mut pass = 0;
    loop {
        let before: u64 = tally.structures.iter().map(|row| row.rays).sum();
        for id in &sweep.scenes {
            let spec: SceneSpec = id.parse()?;
            match scene::load(&spec) {
                Ok(scene) => one_scene(sweep, &scene, choices, sweep.seed + pass, &mut tally),
                Err(error) if error.is_unavailable() => tally.findings.push(format!("passed over: {error}")),
                Err(error) => return Err(error),
            }
            if pass == 0 {
                tell(id);
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
    let session = Session {
        scenes: Vec::new(),
        rays: sweep.rays.clone(),
        size: sweep.size,
        seed,
        options: Options::default(),
        memory: false,
        most_time: None,
        command: String::new(),
    };
    // A set that has no rays on this scene (no objects, no hits) is nothing to check.
    let workloads = workloads(&session, scene, &mut Vec::new());
    for workload in &workloads {
        let mut refs = References { sweep, scene, known: BTreeMap::new() };
        let few = (sweep.tests / 16 / scene.geometry.len().max(1) as u64).max(1);
        let thinned = thin(&workload.rays, usize::try_from(few).unwrap_or(usize::MAX));
        for (row, choice) in choices.iter().enumerate() {
            let traits = &choice.entry.traits;
            let rays = if traits.thins(&workload.rays) { &thinned } else { &workload.rays };
            if !traits.lists && matches!(rays, RaySet::List(_)) {
                continue;
            }
            match guard("the build", || choice.builder.build(scene, &Need::of(rays))) {
                Ok(Ok(accel)) => {
                    for query in [Query::Closest, Query::Occluded] {
                        let place = format!("{}: {} {} {query:?}", choice.spec, scene.id, workload.id);
                        one_set(&mut refs, choice, accel.as_ref(), rays, query, &place, row, tally);
                    }
                }
                Ok(Err(BuildError::Unsupported { .. })) => {}
                Ok(Err(error)) => broken(tally, format!("{}: {}: {error}", choice.spec, scene.id)),
                Err(error) => broken(tally, format!("{}: {}: {error}", choice.spec, scene.id)),
            }
        }
    }
}

/// Brute force's answers to one ray set, each computed once.
struct References<'a> {
    sweep: &'a Sweep,
    scene: &'a Scene,
    known: BTreeMap<(KernelId, Query, usize), Reference>,
}

impl References<'_> {
    fn get(&mut self, kernel: KernelId, query: Query, rays: &RaySet) -> &Reference {
        let make = || Reference::new(self.scene, rays, query, kernel, self.sweep.tests);
        self.known.entry((kernel, query, rays.len())).or_insert_with(make)
    }
}

#[allow(clippy::too_many_arguments)]
fn one_set(
    refs: &mut References,
    choice: &Choice,
    accel: &dyn Accel,
    rays: &RaySet,
    query: Query,
    place: &str,
    row: usize,
    tally: &mut Tally,
) {
    let kernel = KernelId::from_id(choice.kernel()).unwrap_or(KernelId::MollerTrumbore);
    let reference = refs.get(kernel, query, rays);
    let mut answers = Answers::new(query, rays.len());
    if let Err(error) = guard("tracing", || answers.trace(accel, rays)) {
        return broken(tally, format!("{place}: {error}"));
    }
    let different = compare(&answers, reference);
    tally.structures[row].rays += reference.numbers.len() as u64;
    tally.structures[row].differences += different.len() as u64;
    if let (true, Some(first)) = (choice.entry.traits.own_kernel, different.first()) {
        let ray = rays.ray(*first);
        finding(tally, format!("{place}: {} rays differ, first {first}: {ray:?}", different.len()));
    }
}

fn broken(tally: &mut Tally, text: String) {
    tally.broken = true;
    finding(tally, text);
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

    fn sweep(ids: &[&str]) -> Tally {
        let choices: Vec<_> = ids.iter().map(|id| registry::parse(id).unwrap()).collect();
        let sweep = Sweep {
            scenes: vec!["unit-one".into(), "small-100".into()],
            rays: RaysId::ALL.to_vec(),
            size: 12,
            seed: 1,
            rays_each: 10_000,
            tests: 100_000_000,
        };
        run(&sweep, &choices, |_| ()).unwrap()
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
