//! Which structure to use: measured candidates ranked under a user's constraints.

use crate::record::{Cell, Intersector, Outcome, Record};
use crate::stats::{geometric_mean, median};
use crate::units;
use judge::{Counted, Counts, Examined, Limits};
use primitives::KernelId;
use serde::Serialize;
use std::collections::BTreeMap;

/// What a user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Constraints {
    /// Bytes that structure and geometry copy may take together.
    pub memory: Option<u64>,
    /// What errors are put up with.
    pub limits: Limits,
    /// Rays traced for each build; without it the build doesn't count.
    pub rays_per_build: Option<f64>,
}

impl Default for Constraints {
    /// Anything goes.
    fn default() -> Self {
        Self { memory: None, limits: Limits::NONE, rays_per_build: None }
    }
}

/// How many answers are wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum ErrorRate {
    /// None, by proof.
    Proven,
    /// As seen on some rays.
    Seen(Examined),
}

impl ErrorRate {
    /// The share of rays that were seen to have errors of the kinds that count.
    pub fn share(&self, counted: Counted) -> f64 {
        match self {
            Self::Proven => 0.0,
            Self::Seen(found) => found.counts.per_million(found.counts.errors(counted)) / 1e6,
        }
    }

    /// The share that is not ruled out for the user's own rays; 0 if proven.
    pub fn bound(&self, counted: Counted) -> f64 {
        match self {
            Self::Proven => 0.0,
            Self::Seen(found) => found.likely_per_million(found.counts.errors(counted)) / 1e6,
        }
    }

    /// By which factor a limit is exceeded; 1 if all are kept.
    fn excess(&self, limits: &Limits) -> f64 {
        match self {
            Self::Proven => 1.0,
            Self::Seen(found) => limits.excess(&Examined { of: found.counts.rays, ..*found }),
        }
    }

    fn worse(self, other: Self, limits: &Limits) -> Self {
        let order =
            |rate: &Self| (rate.excess(limits), rate.share(limits.counted), rate.bound(limits.counted));
        if order(&other) > order(&self) { other } else { self }
    }
}

/// Whose answers a rate is of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Answerer {
    /// Every built-in structure with this kernel.
    Kernel(KernelId),
    /// An external structure, with its settings.
    Structure(String),
}

/// Rates by who answers and ray set.
pub type ErrorRates = BTreeMap<(Answerer, String), ErrorRate>;

/// A structure with its figures on a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Candidate {
    /// The structure, with the settings to ask for.
    pub structure: String,
    /// What is minimised: ns per ray with the ray's share of the build, geometric mean over ray sets.
    pub cost: f64,
    /// Time per ray in ns, geometric mean over ray sets.
    pub ns: f64,
    /// Time to build in ns, the longest over ray sets: a structure that is built for its rays is built anew for
    /// each of them.
    pub build_ns: f64,
    /// Bytes of structure and geometry copy, the most over ray sets.
    pub bytes: u64,
    /// Wrong answers, the most over ray sets; none where it was not decided.
    pub error: Option<ErrorRate>,
    /// How the candidate fails the constraints, in words; empty if it fits.
    pub misfits: Vec<String>,
    /// By which factor it exceeds what it exceeds most; 1 if it fits.
    pub excess: f64,
}

/// Candidates in order.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Recommendation {
    /// Those that fit, the best first.
    pub fitting: Vec<Candidate>,
    /// Those that don't, the nearest to fitting first.
    pub others: Vec<Candidate>,
    /// Structures without a figure for every ray set, with the reason.
    pub unfit: Vec<(String, String)>,
}

/// Ranks the structures of a record of one scene.
pub fn rank(record: &Record, errors: &ErrorRates, constraints: &Constraints) -> Recommendation {
    let mut all = Recommendation::default();
    let sets = record.ray_sets();
    let scene = record.cells.first().map_or("", |cell| &cell.scene);
    for structure in record.structure_ids() {
        let cells: Vec<&Cell> = record.cells.iter().filter(|c| c.structure == structure).collect();
        let outcome = |set: &str| record.outcome(scene, set, structure);
        match candidate(structure, &cells, &sets, outcome, errors, constraints) {
            Ok(candidate) if candidate.misfits.is_empty() => all.fitting.push(candidate),
            Ok(candidate) => all.others.push(candidate),
            Err(reason) => all.unfit.push((structure.to_owned(), reason)),
        }
    }
    all.fitting.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    all.others.sort_by(|a, b| a.excess.total_cmp(&b.excess).then(a.cost.total_cmp(&b.cost)));
    all
}

fn candidate(
    structure: &str,
    cells: &[&Cell],
    sets: &[&str],
    outcome: impl Fn(&str) -> Outcome,
    errors: &ErrorRates,
    constraints: &Constraints,
) -> Result<Candidate, String> {
    for set in sets {
        if let Some(reason) = outcome(set).reason() {
            return Err(reason.to_owned());
        }
    }
    let figures: Option<Vec<(f64, f64)>> = cells.iter().map(|cell| Some((cell.ns()?, build(cell)))).collect();
    let figures = figures.ok_or("has no sample")?;
    let share = |build: f64| constraints.rays_per_build.map_or(0.0, |rays| build / rays.max(1.0));
    let mean = |values: Vec<f64>| geometric_mean(&values).ok_or("has no sample");
    let bytes = |cell: &&Cell| cell.bytes.as_ref().map_or(0, |b| b.structure + b.geometry_copy);
    let wrong: Option<Vec<ErrorRate>> = cells.iter().map(|cell| error_rate(cell, errors)).collect();
    let mut candidate = Candidate {
        structure: structure.to_owned(),
        cost: mean(figures.iter().map(|(ns, build)| ns + share(*build)).collect())?,
        ns: mean(figures.iter().map(|(ns, _)| *ns).collect())?,
        build_ns: figures.iter().map(|(_, build)| *build).fold(0.0, f64::max),
        bytes: cells.iter().map(bytes).max().unwrap_or(0),
        error: wrong
            .map(|rates| rates.into_iter().fold(ErrorRate::Proven, |a, b| a.worse(b, &constraints.limits))),
        misfits: Vec::new(),
        excess: 1.0,
    };
    if let Some(limit) = constraints.memory.filter(|limit| candidate.bytes > *limit) {
        let excess = candidate.bytes as f64 / limit.max(1) as f64;
        candidate.misfits.push(format!("takes {}", units::bytes(candidate.bytes)));
        candidate.excess = candidate.excess.max(excess);
    }
    if constraints.limits.any() {
        match candidate.error {
            Some(error) if error.excess(&constraints.limits) <= 1.0 => {}
            Some(error) => {
                candidate.misfits.push(complaint(&error, &constraints.limits));
                candidate.excess = candidate.excess.max(error.excess(&constraints.limits));
            }
            None => {
                candidate.misfits.push("its errors are not known".to_owned());
                candidate.excess = f64::INFINITY;
            }
        }
    }
    Ok(candidate)
}

/// Which limits are not kept, in words.
fn complaint(error: &ErrorRate, limits: &Limits) -> String {
    let ErrorRate::Seen(found) = error else { return String::new() };
    let kept = |limits: Limits| error.excess(&limits) <= 1.0;
    let mut all = Vec::new();
    if !kept(Limits { holes: None, displacement: None, ..*limits }) {
        let share = error.share(limits.counted);
        all.push(format!("{} of its answers are {}", per_million(share), limits.counted.words()));
    }
    if !kept(Limits { errors: None, displacement: None, ..*limits }) {
        all.push(format!("{} are holes", per_million(found.counts.per_million(found.counts.holes) / 1e6)));
    }
    if !kept(Limits { errors: None, holes: None, ..*limits }) {
        all.push(format!("a hit is {} of the extent from its place", units::figure(found.farthest)));
    }
    all.join("; ")
}

/// A share of wrong answers in words.
pub fn per_million(share: f64) -> String {
    format!("{} in a million", (share * 1e6).round().max(1.0))
}

/// Median build time in ns.
fn build(cell: &Cell) -> f64 {
    let samples: Vec<f64> = cell.build_ns.iter().map(|ns| *ns as f64).collect();
    median(&samples).unwrap_or(0.0)
}

/// Wrong answers of a cell: those of its kernel or structure or, where these were not examined, what the check of the cell
/// decided exactly or, for rays that only ask whether there is a hit, found to differ from brute force.
fn error_rate(cell: &Cell, errors: &ErrorRates) -> Option<ErrorRate> {
    let answerer = match cell.kernel {
        Intersector::BuiltIn(kernel) => Answerer::Kernel(kernel),
        Intersector::External => Answerer::Structure(cell.structure.clone()),
        Intersector::Unknown(_) => return None,
    };
    let external = matches!(answerer, Answerer::Structure(_));
    let examined = errors.get(&(answerer, cell.rays.clone())).copied();
    if examined.is_some() || !external {
        return examined;
    }
    let check = cell.check.as_ref()?;
    let mut counts = Counts { rays: check.rays_checked, ..Counts::default() };
    match check.errors {
        Some(e) => match e.kinds {
            Some(kinds) => counts = Counts { rays: check.rays_checked, ..kinds },
            None => {
                (counts.holes, counts.phantoms, counts.swapped) = (e.missed, e.false_hits, e.wrong_object)
            }
        },
        // Whether one is missing or invented was not asked.
        None => counts.holes = check.differences,
    }
    Some(ErrorRate::Seen(Examined::all(counts, 0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Errors;
    use crate::testing;

    /// Scene `two` only: a 40 and 80 ns, b 80 and 160, c 20 and 40.
    fn record() -> Record {
        let mut record = testing::record();
        record.cells.retain(|cell| cell.scene == "two");
        record
    }

    fn names(candidates: &[Candidate]) -> Vec<&str> {
        candidates.iter().map(|c| c.structure.as_str()).collect()
    }

    #[test]
    fn the_fastest_is_first_and_building_counts_by_rays() {
        let mut record = record();
        let all = rank(&record, &BTreeMap::new(), &Constraints::default());
        assert_eq!(names(&all.fitting), ["c", "a", "b"]);
        assert!((all.fitting[0].ns - (20.0f64 * 40.0).sqrt()).abs() < 0.5);
        for cell in record.cells.iter_mut().filter(|cell| cell.structure == "c") {
            cell.build_ns = vec![1_000_000_000];
        }
        let constraints = Constraints { rays_per_build: Some(1e6), ..Constraints::default() };
        assert_eq!(names(&rank(&record, &BTreeMap::new(), &constraints).fitting), ["a", "b", "c"]);
        let constraints = Constraints { rays_per_build: Some(1e9), ..Constraints::default() };
        assert_eq!(names(&rank(&record, &BTreeMap::new(), &constraints).fitting), ["c", "a", "b"]);
    }

    #[test]
    fn memory_is_a_limit_and_the_nearest_misfit_comes_first() {
        let mut record = record();
        for cell in &mut record.cells {
            let bytes = cell.bytes.as_mut().unwrap();
            bytes.structure = match cell.structure.as_str() {
                "a" => 1_000_000,
                "b" => 100_000,
                _ => 10_000_000,
            };
        }
        let with = |memory| {
            rank(&record, &BTreeMap::new(), &Constraints { memory: Some(memory), ..Constraints::default() })
        };
        assert_eq!(names(&with(2_000_000).fitting), ["a", "b"]);
        let none = with(50_000);
        assert!(none.fitting.is_empty());
        assert_eq!(names(&none.others), ["b", "a", "c"]);
        assert!(none.others[0].misfits[0].contains("KiB"), "{:?}", none.others[0].misfits);
    }

    #[test]
    fn errors_count_by_kernel_or_by_structure() {
        let mut record = record();
        for cell in record.cells.iter_mut().filter(|cell| cell.structure == "c") {
            cell.kernel = Intersector::External;
            cell.check.as_mut().unwrap().errors =
                Some(Errors { missed: 2, rays_exact: 1000, ..Errors::default() });
        }
        let key = |rays: &str| (Answerer::Kernel(KernelId::MollerTrumbore), rays.to_owned());
        let rate =
            |holes| ErrorRate::Seen(Examined::all(Counts { rays: 100_000, holes, ..Counts::default() }, 0.0));
        let errors: ErrorRates = [(key("parallel"), rate(0)), (key("random"), rate(10))].into();
        let limits = Limits { errors: Some(1e3), ..Limits::NONE };
        let constraints = Constraints { limits, ..Constraints::default() };
        let all = rank(&record, &errors, &constraints);
        assert_eq!(names(&all.fitting), ["a", "b"]);
        assert_eq!(all.fitting[0].error.unwrap().share(Counted::Visible), 1e-4);
        assert_eq!(all.others[0].error.unwrap().share(Counted::Visible), 2e-3);
        let mut examined = errors.clone();
        examined.extend(
            ["parallel", "random"]
                .map(|rays| ((Answerer::Structure("c".to_owned()), rays.to_owned()), rate(1))),
        );
        let all = rank(&record, &examined, &constraints);
        assert_eq!(
            names(&all.fitting),
            ["c", "a", "b"],
            "examined itself, whatever its cells were checked for"
        );
        let unknown = rank(&record, &BTreeMap::new(), &constraints);
        assert!(unknown.fitting.is_empty(), "what is not known does not fit");
    }

    #[test]
    fn what_was_not_seen_is_not_ruled_out_but_by_proof() {
        let none = ErrorRate::Seen(Examined::all(Counts { rays: 30_000, ..Counts::default() }, 0.0));
        let (share, bound) = (none.share(Counted::Visible), none.bound(Counted::Visible));
        assert!(share == 0.0 && (0.9e-4..1.1e-4).contains(&bound), "{none:?}");
        assert_eq!(ErrorRate::Proven.worse(none, &Limits::NONE), none);
    }

    #[test]
    fn another_object_in_the_same_place_counts_only_where_asked() {
        let record = record();
        let swapped = Counts { rays: 1000, swapped: 500, ..Counts::default() };
        let rate = ErrorRate::Seen(Examined::all(swapped, 0.0));
        let key = |rays: &str| (Answerer::Kernel(KernelId::MollerTrumbore), rays.to_owned());
        let errors: ErrorRates = [(key("parallel"), rate), (key("random"), rate)].into();
        let constraints = |counted| Constraints {
            limits: Limits { errors: Some(1.0), counted, ..Limits::NONE },
            ..Constraints::default()
        };
        assert_eq!(rank(&record, &errors, &constraints(Counted::Visible)).fitting.len(), 3);
        let identity = rank(&record, &errors, &constraints(Counted::Identity));
        assert!(identity.fitting.is_empty() && identity.others[0].misfits[0].contains("another object"));
    }

    #[test]
    fn structures_without_figures_are_named_with_the_reason() {
        let mut record = record();
        record.cells[0].outcome = Outcome::Failed("it fell over".into());
        record.cells.retain(|cell| cell.structure != "b" || cell.rays != "random");
        let all = rank(&record, &BTreeMap::new(), &Constraints::default());
        assert_eq!(names(&all.fitting), ["c"]);
        assert_eq!(
            all.unfit,
            [
                ("a".to_owned(), "it fell over".to_owned()),
                ("b".to_owned(), "does not serve random rays".to_owned()),
            ]
        );
    }
}
