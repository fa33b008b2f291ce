//! One ray set of a scene in one pass: the structures are warmed up and checked, then sampled.

use super::build::{Absent, Built};
use super::failure::Failure;
use super::job::Job;
use super::trace::{Runner, rounds};
use crate::answers::Answers;
use crate::check::{self, Reference, compare};
use crate::guard::guard;
use crate::record::{Cell, Check, Outcome, Query};
use crate::registry::Choice;
use crate::workload::{RayQuery, in_time, sample, subsample};
use accel::{Accel, Builder, Counters, Geometry, RaySet, Scene, Workload};
use baselines::Brute;
use judge::{Judge, Tolerance};
use primitives::KernelId;
use scenes::rays::RaysId;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// What passes leave to later ones, by ray set and structure.
pub type Entries<'w> = BTreeMap<(RaysId, String), Entry<'w>>;

/// A structure on a ray set, between two passes.
pub struct Entry<'w> {
    /// Its rays: the set, or fewer of them.
    rays: Cow<'w, RaySet>,
    /// What it answered when it was checked; none where it failed.
    fingerprint: Option<u64>,
    /// Samples of builds that an earlier run left.
    earlier_builds: Vec<u64>,
    /// Why it is not sampled any more.
    failure: Option<Failure>,
    cell: Cell,
}

impl Entry<'_> {
    fn fail(&mut self, failure: impl Into<Failure>) {
        let failure = failure.into();
        self.cell.outcome = failure.clone().into();
        self.failure = Some(failure);
    }
}

/// Brute force and the judge, built when first asked for.
pub struct References<'s> {
    scene: &'s Scene,
    brute: BTreeMap<KernelId, Box<dyn Accel + 's>>,
    judge: Option<Judge<'s>>,
}

impl<'s> References<'s> {
    /// None built yet.
    pub fn new(scene: &'s Scene) -> Self {
        Self { scene, brute: BTreeMap::new(), judge: None }
    }

    fn brute(&mut self, kernel: KernelId) -> &dyn Accel {
        let scene = self.scene;
        let build =
            || Brute::new(kernel).build(scene, &Workload::GENERAL).expect("brute force serves every scene");
        &**self.brute.entry(kernel).or_insert_with(build)
    }

    fn judge(&mut self) -> Option<&Judge<'s>> {
        if let (None, Geometry::Triangles(_)) = (&self.judge, &self.scene.geometry) {
            self.judge = Some(Judge::new(self.scene, Tolerance::VISIBLE));
        }
        self.judge.as_ref()
    }
}

/// Reference answers for a ray set, by kernel and number of rays.
type Checked = Vec<(KernelId, usize, Reference)>;

/// Takes the samples of a pass and gives the cells as they are then; none if interrupted.
pub fn ray_set<'w>(
    job: &Job<'w>,
    pass: usize,
    asked: &'w RayQuery,
    entrants: &[(&Choice, &Built)],
    entries: &mut Entries<'w>,
    refs: &mut References,
) -> Option<Vec<Cell>> {
    let mut checked = Checked::new();
    let mut all: Vec<(Entry, Option<Answers>)> = Vec::new();
    for (choice, built) in entrants {
        if job.deadline.interrupted() {
            return None;
        }
        let name = (asked.id, choice.spec.to_string());
        all.push(match entries.remove(&name) {
            Some(entry) => {
                warm_up(choice, built, &entry);
                (entry, None)
            }
            None => enter(job, asked, choice, built, &mut checked, refs),
        });
    }
    let mut runners = Vec::new();
    for ((entry, first), (_, built)) in all.iter_mut().zip(entrants) {
        match &built.accel {
            Err(Absent::Failed(failure)) => entry.fail(failure.clone()),
            Err(Absent::Dropped) => unreachable!("every pass builds what was dropped"),
            Ok(accel) => runners.push(Runner {
                accel: accel.as_ref(),
                rays: &entry.rays,
                query: asked.query,
                first: first.take(),
                trace_ns: entry.cell.trace_ns.clone(),
                failure: entry.failure.clone(),
            }),
        }
    }
    rounds(&mut runners, (job.options, pass), job.deadline)?;
    let done: Vec<_> = runners.into_iter().map(|r| (r.trace_ns, r.first, r.failure)).collect();
    let mut done = done.into_iter();
    let mut cells = Vec::new();
    for ((mut entry, _), (choice, built)) in all.into_iter().zip(entrants) {
        if let Ok(accel) = &built.accel {
            let (trace_ns, first, failure) = done.next().expect("one runner for each structure built");
            let cell = &mut entry.cell;
            cell.passes.push(trace_ns.len() - cell.trace_ns.len());
            cell.trace_ns = trace_ns;
            cell.build_ns = [&entry.earlier_builds[..], &built.build_ns].concat();
            if let Some(failure) = failure {
                entry.fail(failure);
            }
            if let Some(first) = first.filter(|first| entry.fingerprint != Some(first.fingerprint())) {
                answers_of_another_build(job, choice, &first, &mut entry, &mut checked, refs);
            }
            let cell = &mut entry.cell;
            cell.summarise();
            if job.options.counters && cell.outcome.is_measured() && cell.counters.is_none() {
                let count = || accel.count(&entry.rays, asked.query == Query::Occluded);
                cell.counters =
                    guard("counting", count).ok().flatten().map(|c| per_ray(&c, entry.rays.len()));
            }
        }
        cells.push(entry.cell.clone());
        entries.insert((asked.id, choice.spec.to_string()), entry);
    }
    Some(cells)
}

/// Begins with a structure: chooses its rays, traces them once and checks the answers, which are given too. Samples
/// that an earlier run left of the same rays stay.
fn enter<'w>(
    job: &Job,
    asked: &'w RayQuery,
    choice: &Choice,
    built: &Built,
    checked: &mut Checked,
    refs: &mut References,
) -> (Entry<'w>, Option<Answers>) {
    let rays = rays_for(job, asked, choice, built);
    let cell = blank(job, asked, choice, built, &rays);
    let mut entry = Entry { rays, fingerprint: None, earlier_builds: Vec::new(), failure: None, cell };
    if let Some(known) = job.known(asked, choice).filter(|known| known.ray_count == entry.cell.ray_count) {
        entry.cell.trace_ns.clone_from(&known.trace_ns);
        entry.cell.passes.clone_from(&known.passes);
        entry.earlier_builds.clone_from(&known.build_ns);
    }
    let Ok(accel) = &built.accel else { return (entry, None) };
    let mut answers = Answers::new(asked.query, entry.rays.len());
    if let Err(panicked) = guard("tracing", || answers.trace(accel.as_ref(), &entry.rays)) {
        entry.fail(panicked);
        return (entry, None);
    }
    let check = check(job, choice, &entry.rays, &answers, checked, refs);
    entry.cell.hits = answers.hits() as u64;
    entry.cell.plan = accel.plan();
    if let Some(failure) = verdict(choice, &check) {
        entry.fail(failure);
    }
    entry.cell.check = Some(check);
    entry.fingerprint = Some(answers.fingerprint());
    (entry, Some(answers))
}

/// The rays that a structure has time for.
fn rays_for<'w>(job: &Job, asked: &'w RayQuery, choice: &Choice, built: &Built) -> Cow<'w, RaySet> {
    if choice.entry.traits.subsamples(&asked.rays) {
        let objects = job.scene.geometry.len();
        let few = (job.options.linear_tests / objects.max(1) as u64).max(16) as usize;
        return Cow::Owned(subsample(&asked.rays, few));
    }
    match &built.accel {
        Ok(accel) if !of_one_raster(choice, &asked.rays) => {
            in_time(accel.as_ref(), &asked.rays, asked.query, job.options.sample_time)
        }
        _ => Cow::Borrowed(&asked.rays),
    }
}

/// Whether a structure is built for just these rays and can't be asked for fewer of them.
fn of_one_raster(choice: &Choice, rays: &RaySet) -> bool {
    choice.entry.traits.by_workload && matches!(rays, RaySet::Raster(_))
}

/// Brings a structure into the caches again. An eighth of the rays meets most of it.
fn warm_up(choice: &Choice, built: &Built, entry: &Entry) {
    let (Ok(accel), None) = (&built.accel, &entry.failure) else { return };
    let rays = match entry.rays.as_ref() {
        rays if of_one_raster(choice, rays) => Cow::Borrowed(rays),
        rays => Cow::Owned(subsample(rays, rays.len().div_ceil(8))),
    };
    let mut answers = Answers::new(entry.cell.query, rays.len());
    // Whoever panics here does so again in the first sample, where it is recorded.
    let _ = guard("tracing", || answers.trace(accel.as_ref(), &rays));
}

/// What another build of a structure answered is checked like the first; one of the suite's own structures may not
/// answer differently at all.
fn answers_of_another_build(
    job: &Job,
    choice: &Choice,
    answers: &Answers,
    entry: &mut Entry,
    checked: &mut Checked,
    refs: &mut References,
) {
    let again = check(job, choice, &entry.rays, answers, checked, refs);
    if choice.entry.traits.built_in && entry.failure.is_none() {
        entry.fail(verdict(choice, &again).unwrap_or(Failure::OtherBuild));
    }
    let worse = |check: &Check| check.differences < again.differences;
    if entry.cell.check.as_ref().is_none_or(worse) {
        entry.cell.check = Some(again);
    }
}

fn blank(job: &Job, asked: &RayQuery, choice: &Choice, built: &Built, rays: &RaySet) -> Cell {
    Cell {
        scene: job.scene.id.clone(),
        rays: asked.id.to_string(),
        query: asked.query,
        structure: choice.spec.to_string(),
        kernel: choice.intersector(),
        kernel_reason: choice.reason().to_owned(),
        threads: job.options.threads,
        ray_count: rays.len() as u64,
        hits: 0,
        build_ns: built.build_ns.clone(),
        trace_ns: Vec::new(),
        passes: Vec::new(),
        ns_per_ray: None,
        bytes: built.bytes.clone(),
        plan: String::new(),
        counters: None,
        check: None,
        outcome: Outcome::Measured,
    }
}

/// Compares with brute force by the structure's kernel; an external structure is compared with
/// Möller–Trumbore, and where it differs the exact oracle judges.
fn check(
    job: &Job,
    choice: &Choice,
    rays: &RaySet,
    answers: &Answers,
    checked: &mut Checked,
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
    if let (false, Some(hits)) = (choice.entry.traits.built_in, answers.closest()) {
        let spread = sample(reference.numbers.len(), job.options.exact_rays);
        let most = job.options.exact_rays * 20;
        let mut numbers: Vec<usize> = spread.into_iter().map(|j| reference.numbers[j]).collect();
        numbers.extend(sample(different.len(), most).into_iter().map(|j| different[j]));
        numbers.sort_unstable();
        numbers.dedup();
        check.errors = refs.judge().map(|judge| check::judge(judge, rays, hits, &numbers));
    }
    check
}

/// One of the suite's own structures that differs from brute force is broken.
fn verdict(choice: &Choice, check: &Check) -> Option<Failure> {
    let broken = choice.entry.traits.built_in && check.differences > 0;
    broken.then_some(Failure::Differs { differences: check.differences, rays: check.rays_checked })
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
