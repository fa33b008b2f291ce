//! Measuring structures of all kinds, faulty ones among them.

use super::*;
use crate::record::{Cell, Intersector, Outcome, Query};
use crate::registry::{self, Choice, ChosenKernel, Entry};
use crate::testing;
use crate::workload::RayQuery;
use accel::{Accel, BuildError, Builder, Footprint, Hit, Ray, RaySet, Scene, Workload};
use baselines::MinMax;
use primitives::KernelId;
use scenes::rays::RaysId;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

fn quick() -> Options {
    Options { passes: 1, rounds: 3, build_rounds: 2, ..Options::default() }
}

fn queries(scene_rays: RaySet) -> Vec<RayQuery> {
    vec![
        RayQuery {
            id: RaysId::Parallel,
            rays: RaySet::Raster(testing::raster(64, 64)),
            query: Query::Closest,
        },
        RayQuery { id: RaysId::Random, rays: scene_rays.clone(), query: Query::Closest },
        RayQuery { id: RaysId::Shadow, rays: scene_rays, query: Query::Occluded },
    ]
}

fn cells(choices: &[Choice], options: &Options) -> Vec<Cell> {
    let (scene, rays) = testing::cloud(400, 2000);
    let queries = queries(rays);
    let mut told = Vec::new();
    let deadline = Deadline::default();
    let job = Job { scene: &scene, queries: &queries, choices, options, known: &[], deadline: &deadline };
    let mut cells: Vec<Cell> = Vec::new();
    measure(&job, |asked, pass, more| {
        told.push((pass, asked.id));
        cells.retain(|cell| cell.rays != asked.id.name());
        cells.extend(more);
    });
    let ids = [RaysId::Parallel, RaysId::Random, RaysId::Shadow];
    let expected = (0..options.passes()).flat_map(|pass| ids.map(|id| (pass, id)));
    assert_eq!(told, expected.collect::<Vec<_>>());
    cells
}

#[test]
fn nothing_is_built_when_time_is_up() {
    let (scene, _) = testing::cloud(400, 1);
    let choice = registry::parse("minmax").unwrap();
    let up = Deadline::new(Arc::default(), Some(Duration::ZERO));
    for (deadline, builds) in [(up, 0), (Deadline::default(), 1)] {
        let mut all = Vec::new();
        let built =
            build::build_all(&scene, &[(&choice, Workload::GENERAL)], (&quick(), 0), &deadline, &mut all);
        assert_eq!((built.is_some(), all.len()), (builds > 0, builds));
    }
}

#[test]
fn every_structure_has_a_cell_for_every_ray_set() {
    let ids = ["brute", "minmax", "sphere:kernel=watertight"];
    let choices: Vec<_> = ids.iter().map(|id| registry::parse(id).unwrap()).collect();
    let options = Options { counters: true, passes: 2, ..quick() };
    let cells = cells(&choices, &options);
    assert_eq!(cells.len(), 9);
    for cell in &cells {
        assert_eq!(cell.outcome, Outcome::Measured);
        assert_eq!((cell.trace_ns.len(), cell.build_ns.len()), (3, 2));
        assert_eq!(cell.passes, [2, 1]);
        let check = cell.check.as_ref().unwrap();
        assert_eq!((check.rays_checked, check.differences), (cell.ray_count, 0));
        assert!(cell.hits > 0 && cell.ns().unwrap() > 0.0);
    }
    assert_eq!(cells[2].kernel, Intersector::BuiltIn(KernelId::Watertight));
    assert_eq!(cells[1].counters.as_ref().unwrap()["candidates"], 400.0);
}

#[test]
fn linear_structures_get_fewer_rays() {
    let choices = [registry::parse("minmax").unwrap()];
    let cells = cells(&choices, &Options { linear_tests: 400 * 100, ..quick() });
    assert_eq!(cells.iter().map(|c| c.ray_count).collect::<Vec<_>>(), [100, 100, 100]);
}

#[test]
fn slow_structures_get_as_many_rays_as_there_is_time_for() {
    let choices = [registry::parse("brute").unwrap(), registry::parse("ssm").unwrap()];
    let options = Options { linear_tests: u64::MAX, sample_time: Duration::from_nanos(1), ..quick() };
    let rays =
        |options: &Options| -> Vec<u64> { cells(&choices, options).iter().map(|c| c.ray_count).collect() };
    assert!(rays(&options).chunks(2).all(|two| two[0] > 1000 && (1..=64).contains(&two[1])));
    let ample = Options { sample_time: Duration::from_secs(1000), ..options };
    assert!(rays(&ample).iter().all(|n| *n >= 2000), "all rays where time is ample");
}

/// Right, but for one thing.
struct Odd(Fault, AtomicUsize);

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    RefusesToBuild,
    PanicsInBuild,
    PanicsInTrace,
    LosesHits,
    ChangesItsMind,
    WritesNothingLater,
    OtherWhenBuiltAgain,
}

struct OddAccel<'s>(Box<dyn Accel + 's>, Fault, AtomicUsize);

impl Builder for Odd {
    fn id(&self) -> &str {
        "odd"
    }

    fn build<'s>(&self, scene: &'s Scene, workload: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        if self.0 == Fault::RefusesToBuild {
            return Err(BuildError::Unsupported { structure: "odd".into(), what: "anything".into() });
        }
        assert!(self.0 != Fault::PanicsInBuild, "no build today");
        let inner = MinMax { kernel: KernelId::MollerTrumbore }.build(scene, workload)?;
        // The second timed build is the first of the second pass; the one before them was watched for memory.
        let fault = match (self.0, self.1.fetch_add(1, Ordering::Relaxed)) {
            (Fault::OtherWhenBuiltAgain, 0..2) => Fault::None,
            (fault, _) => fault,
        };
        Ok(Box::new(OddAccel(inner, fault, AtomicUsize::new(0))))
    }
}

impl Accel for OddAccel<'_> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.0.closest(ray)
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        // Trials of a few rays are no traces of the set.
        let whole = usize::from(rays.len() > 64);
        let time = self.2.fetch_add(whole, Ordering::Relaxed);
        if self.1 == Fault::WritesNothingLater && time > 0 {
            return;
        }
        self.0.trace(rays, hits);
        match self.1 {
            Fault::PanicsInTrace => panic!("no trace {}", "today"),
            Fault::LosesHits => hits.iter_mut().step_by(100).for_each(|hit| *hit = None),
            Fault::ChangesItsMind if time == 2 => *hits.iter_mut().rfind(|h| h.is_some()).unwrap() = None,
            Fault::OtherWhenBuiltAgain => *hits.iter_mut().rfind(|h| h.is_some()).unwrap() = None,
            _ => {}
        }
    }

    fn footprint(&self) -> Footprint {
        self.0.footprint()
    }
}

fn odd(fault: Fault) -> Cell {
    static ENTRY: Entry = Entry::new("odd", |_| unreachable!("made by the test"));
    let odd = Choice {
        spec: "odd".parse().unwrap(),
        entry: &ENTRY,
        kernel: ChosenKernel::Given(KernelId::MollerTrumbore),
        builder: Arc::new(Odd(fault, AtomicUsize::new(0))),
    };
    let choices = [registry::parse("minmax").unwrap(), odd];
    let passes = if fault == Fault::OtherWhenBuiltAgain { 2 } else { 1 };
    let cells = cells(&choices, &Options { passes, ..quick() });
    let sound = cells.iter().filter(|c| c.structure == "minmax");
    assert_eq!(sound.filter(|c| c.outcome.is_measured() && c.trace_ns.len() == 3).count(), 3, "others go on");
    cells.into_iter().find(|c| c.structure == "odd" && c.rays == "parallel").unwrap()
}

#[test]
fn what_goes_wrong_is_recorded() {
    assert_eq!(odd(Fault::None).outcome, Outcome::Measured);
    for (fault, says) in [
        (Fault::RefusesToBuild, "odd does not serve anything"),
        (Fault::PanicsInBuild, "the build panicked: no build today"),
        (Fault::PanicsInTrace, "tracing panicked: no trace today"),
        (Fault::LosesHits, "rays differ from brute force"),
        (Fault::ChangesItsMind, "of a timed trace has another answer"),
        (Fault::WritesNothingLater, "ray 0 of a timed trace has another answer"),
        (Fault::OtherWhenBuiltAgain, "1 of 4096 rays differ from brute force"),
    ] {
        let cell = odd(fault);
        let error = cell.outcome.reason().unwrap_or_default();
        assert!(error.contains(says), "`{error}` should say `{says}`");
        assert_eq!((cell.ns(), cell.build()), (None, None), "a cell that failed has no time: {says}");
    }
}
