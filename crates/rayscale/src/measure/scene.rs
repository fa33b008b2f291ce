//! All cells of one scene.

use super::Options;
use super::build::{Built, build_all};
use super::guard::guard;
use super::pace::in_time;
use super::trace::{Runner, rounds};
use super::watch::Watch;
use crate::answers::Answers;
use crate::check::{Reference, compare, judge, oracle_of};
use crate::rayset::{Workload, sample, thin};
use crate::record::{Cell, Check, Query};
use crate::registry::Choice;
use accel::baseline::Brute;
use accel::exact::Oracle;
use accel::{Accel, Builder, Counters, Geometry, KernelId, Need, RaySet, Scene};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// What is to be measured on a scene.
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Ray sets.
    pub workloads: &'a [Workload],
    /// Structures.
    pub choices: &'a [Choice],
    /// How much.
    pub options: &'a Options,
    /// Cells that are there already, as ray set and structure.
    pub done: &'a BTreeSet<(String, String)>,
    /// When to stop.
    pub watch: &'a Watch,
}

impl Job<'_> {
    /// Whether a cell is to be measured: it is served and not there already.
    pub fn wants(&self, workload: &Workload, choice: &Choice) -> bool {
        let served = choice.entry.traits.lists || matches!(workload.rays, RaySet::Raster(_));
        served && !self.done.contains(&(workload.id.clone(), choice.spec.to_string()))
    }
}

/// Builds, checks and measures; one cell for every structure and ray set, except lists of rays for
/// structures that serve none. `keep` gets the cells of every ray set once it is done; no ray set begins after
/// the watch's end, and one that is interrupted has no cells.
///
/// Runs in the current thread pool.
pub fn measure(job: &Job, keep: impl FnMut(&Workload, Vec<Cell>)) {
    // None is an interruption, after which there is nothing to do.
    let _ = all_ray_sets(job, keep);
}

fn all_ray_sets(job: &Job, mut keep: impl FnMut(&Workload, Vec<Cell>)) -> Option<()> {
    let choices = crate::auto::resolve(job.choices, job.scene, job.workloads);
    let job = &Job { choices: &choices, ..*job };
    let mut references = References::new(job);
    let build = |wanted: &[(&Choice, Need)]| build_all(job.scene, wanted, job.options, job.watch);
    let missing = |choice: &Choice| job.workloads.iter().any(|w| job.wants(w, choice));
    // Needs that no two ray sets share come one at a time, so that not all builds are held at once.
    let general: Vec<&Choice> = job.choices.iter().filter(|c| !by_need(c) && missing(c)).collect();
    let wanted: Vec<_> = general.iter().map(|c| (*c, need_of_all(c, job))).collect();
    let built = build(&wanted)?;
    let is_list = |workload: &&Workload| matches!(workload.rays, RaySet::List(_));
    let misses_list = |c: &Choice| job.workloads.iter().filter(is_list).any(|w| job.wants(w, c));
    let lists: Vec<&Choice> = job.choices.iter().filter(|c| by_need(c) && misses_list(c)).collect();
    let wanted: Vec<_> = lists.iter().map(|c| (*c, Need::GENERAL)).collect();
    let for_lists = build(&wanted)?;
    for workload in job.workloads {
        if job.watch.is_over() {
            return None;
        }
        let mut entrants: Vec<(&Choice, &Built)> = general.iter().copied().zip(&built).collect();
        let for_raster;
        match workload.rays {
            RaySet::List(_) => entrants.extend(lists.iter().copied().zip(&for_lists)),
            RaySet::Raster(_) => {
                let need = Need::of(&workload.rays);
                let of_need = job.choices.iter().filter(|c| by_need(c) && job.wants(workload, c));
                let wanted: Vec<_> = of_need.map(|c| (c, need)).collect();
                for_raster = build(&wanted)?;
                entrants.extend(wanted.iter().map(|(c, _)| *c).zip(&for_raster));
            }
        }
        entrants.retain(|(choice, _)| job.wants(workload, choice));
        if entrants.is_empty() {
            continue;
        }
        let place = |choice: &Choice| job.choices.iter().position(|c| std::ptr::eq(c, choice));
        entrants.sort_by_key(|(choice, _)| place(choice));
        keep(workload, ray_set(job, workload, &entrants, &mut references)?);
    }
    Some(())
}

fn by_need(choice: &Choice) -> bool {
    choice.entry.traits.by_need
}

fn need_of_all(choice: &Choice, job: &Job) -> Need {
    let raster = job.workloads.iter().map(|w| Need::of(&w.rays)).find(|need| need.raster.is_some());
    match raster {
        Some(need) if !choice.entry.traits.lists => need,
        _ => Need::GENERAL,
    }
}

/// Brute force and the exact oracle, built when first asked for.
struct References<'s> {
    scene: &'s Scene,
    brute: BTreeMap<KernelId, Box<dyn Accel + 's>>,
    oracle: Option<Oracle>,
}

impl<'s> References<'s> {
    fn new(job: &Job<'s>) -> Self {
        Self { scene: job.scene, brute: BTreeMap::new(), oracle: None }
    }

    fn brute(&mut self, kernel: KernelId) -> &dyn Accel {
        let scene = self.scene;
        let build =
            || Brute::new(kernel).build(scene, &Need::GENERAL).expect("brute force serves every scene");
        &**self.brute.entry(kernel).or_insert_with(build)
    }

    fn oracle(&mut self) -> Option<&Oracle> {
        if let (None, Geometry::Triangles(_)) = (&self.oracle, &self.scene.geometry) {
            self.oracle = Some(oracle_of(self.scene));
        }
        self.oracle.as_ref()
    }
}

fn ray_set(
    job: &Job,
    workload: &Workload,
    entrants: &[(&Choice, &Built)],
    refs: &mut References,
) -> Option<Vec<Cell>> {
    let objects = job.scene.geometry.len();
    let few = (job.options.linear_tests / objects.max(1) as u64).max(16) as usize;
    let thinned = thin(&workload.rays, few);
    let chosen: Vec<Cow<RaySet>> = entrants
        .iter()
        .map(|(choice, built)| {
            if choice.entry.traits.thins(&workload.rays) {
                return Cow::Borrowed(&thinned);
            }
            let raster_only = choice.entry.traits.by_need && matches!(workload.rays, RaySet::Raster(_));
            match &built.accel {
                Ok(accel) if !raster_only => {
                    in_time(accel.as_ref(), &workload.rays, workload.query, job.options.sample_time)
                }
                _ => Cow::Borrowed(&workload.rays),
            }
        })
        .collect();
    let mut checked: Vec<(KernelId, usize, Reference)> = Vec::new();
    let mut runners = Vec::new();
    let mut cells = Vec::new();
    for ((choice, built), rays) in entrants.iter().zip(&chosen) {
        if job.watch.interrupted() {
            return None;
        }
        let rays = rays.as_ref();
        let mut cell = blank(job, workload, choice, built, rays);
        match &built.accel {
            Err(error) => cell.error = Some(error.clone()),
            Ok(accel) => {
                let mut first = Answers::new(workload.query, rays.len());
                match guard("tracing", || first.trace(accel.as_ref(), rays)) {
                    Err(error) => cell.error = Some(error),
                    Ok(()) => {
                        cell.hits = first.hits() as u64;
                        cell.plan = accel.plan();
                        cell.check = Some(check(job, choice, rays, &first, &mut checked, refs));
                        cell.error = verdict(choice, cell.check.as_ref());
                    }
                }
                runners.push(Runner {
                    accel: accel.as_ref(),
                    rays,
                    first,
                    trace_ns: Vec::new(),
                    error: cell.error.clone(),
                });
            }
        }
        cells.push(cell);
    }
    rounds(&mut runners, job.options, job.watch)?;
    let mut done = runners.into_iter();
    for (cell, (_, built)) in cells.iter_mut().zip(entrants) {
        let Ok(accel) = &built.accel else { continue };
        let runner = done.next().expect("one runner for each structure built");
        cell.trace_ns = runner.trace_ns;
        cell.error = runner.error;
        cell.summarise();
        if job.options.counters && cell.error.is_none() {
            let count = || accel.count(runner.rays, workload.query == Query::Occluded);
            cell.counters = guard("counting", count).ok().flatten().map(|c| per_ray(&c, runner.rays.len()));
        }
    }
    Some(cells)
}

fn blank(job: &Job, workload: &Workload, choice: &Choice, built: &Built, rays: &RaySet) -> Cell {
    Cell {
        scene: job.scene.id.clone(),
        rays: workload.id.clone(),
        query: workload.query,
        structure: choice.spec.to_string(),
        kernel: choice.kernel().to_owned(),
        kernel_reason: choice.reason().to_owned(),
        threads: job.options.threads,
        ray_count: rays.len() as u64,
        hits: 0,
        build_ns: built.build_ns.clone(),
        trace_ns: Vec::new(),
        ns_per_ray: None,
        bytes: built.bytes.clone(),
        plan: String::new(),
        counters: None,
        check: None,
        error: None,
    }
}

/// Compares with brute force by the structure's kernel; a foreign structure is compared with
/// Möller–Trumbore, and where it differs the exact oracle judges.
fn check(
    job: &Job,
    choice: &Choice,
    rays: &RaySet,
    answers: &Answers,
    checked: &mut Vec<(KernelId, usize, Reference)>,
    refs: &mut References,
) -> Check {
    let kernel = choice.reference_kernel();
    let query = match answers {
        Answers::Closest(_) => Query::Closest,
        Answers::Occluded(_) => Query::Occluded,
    };
    if !checked.iter().any(|(k, len, _)| (*k, *len) == (kernel, rays.len())) {
        let brute = refs.brute(kernel);
        let reference = Reference::by(brute, job.scene.geometry.len(), rays, query, job.options.check_tests);
        checked.push((kernel, rays.len(), reference));
    }
    let known = checked.iter().find(|(k, len, _)| (*k, *len) == (kernel, rays.len()));
    let (_, _, reference) = known.expect("made above");
    let different = compare(answers, reference);
    let mut check = Check {
        rays_checked: reference.numbers.len() as u64,
        differences: different.len() as u64,
        errors: None,
    };
    if let (false, Some(hits)) = (choice.entry.traits.own_kernel, answers.closest()) {
        let spread = sample(reference.numbers.len(), job.options.exact_rays);
        let most = job.options.exact_rays * 20;
        let mut numbers: Vec<usize> = spread.into_iter().map(|j| reference.numbers[j]).collect();
        numbers.extend(sample(different.len(), most).into_iter().map(|j| different[j]));
        numbers.sort_unstable();
        numbers.dedup();
        check.errors = refs.oracle().map(|oracle| judge(oracle, rays, hits, &numbers));
    }
    check
}

/// One of the suite's own structures that differs from brute force is broken.
fn verdict(choice: &Choice, check: Option<&Check>) -> Option<String> {
    let check = check.filter(|check| choice.entry.traits.own_kernel && check.differences > 0)?;
    Some(format!("{} of {} rays differ from brute force", check.differences, check.rays_checked))
}

fn per_ray(counters: &Counters, rays: usize) -> BTreeMap<String, f64> {
    let Counters { words, blocks, cells, candidates, tests } = *counters;
    let all = [
        ("words", words),
        ("blocks", blocks),
        ("cells", cells),
        ("candidates", candidates),
        ("tests", tests),
    ];
    all.into_iter().map(|(name, n)| (name.to_owned(), n as f64 / rays.max(1) as f64)).collect()
}
