//! The study: scene by scene, measured and judged.

use crate::judged::{Judged, Set};
use crate::{FORMAT, Trade, TradeRow, curve, extremes, leaving, mark_front};
use accel::{Geometry, Scene, Workload};
use harness::guard::guard;
use harness::machine::Machine;
use harness::measure::{Deadline, Failure, Job, Options, measure};
use harness::progress::{Event, Listener};
use harness::record::{Cell, SceneEntry, Skipped, Suite};
use harness::registry::{self, Choice, StructureSpec, guarded_build};
use harness::stats::geometric_mean;
use harness::workload::{self, RayQueries, RayQuery, batches};
use judge::{Judge, Tally, Tolerance};
use primitives::KernelId;
use scenes::rays::RaysId;
use scenes::{SceneError, SceneSpec};

/// The ordinary sets: images, ambient occlusion, reflected light.
pub const ORDINARY: [RaysId; 4] = [RaysId::Perspective, RaysId::Parallel, RaysId::Ambient, RaysId::Diffuse];

/// The sets that hunt for errors.
pub const HUNTING: [RaysId; 8] = [
    RaysId::Random,
    RaysId::Edge,
    RaysId::Vertex,
    RaysId::Directions,
    RaysId::Surface,
    RaysId::LeakFace,
    RaysId::LeakEdge,
    RaysId::LeakVertex,
];

/// The ray sets that are timed by default.
pub const TIMED: [RaysId; 3] = [RaysId::Perspective, RaysId::Diffuse, RaysId::Random];

/// What is compared.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Scenes by name; those of boxes are passed over.
    pub scenes: Vec<String>,
    /// Ray sets that are timed.
    pub timed: Vec<RaysId>,
    /// Rows and columns of the sets that are timed.
    pub size: u32,
    /// Ordinary sets that are judged.
    pub ordinary: Vec<RaysId>,
    /// Rows and columns of each of them: a set has their product of rays.
    pub judged: u32,
    /// The same of the sets that hunt for errors.
    pub hunting: u32,
    /// Scenes for the curve of precisions and for rays that leave surfaces, by name.
    pub curve: Vec<String>,
    /// Rays for each extreme, 0 for none.
    pub extremes: usize,
    /// Triangles of the largest extreme, 0 for none.
    pub largest: usize,
    /// Threads that judge. Times are taken on those of the pool that [`run`] is called in.
    pub judges: usize,
    /// Seed of lists of rays.
    pub seed: u64,
    /// How much is measured.
    pub options: Options,
    /// The command as given.
    pub command: String,
}

/// The suite's structures with every kernel, and the others by their defaults and variants. Lossy kernels are for structures
/// whose time they change: not for those that test every object anyway.
pub fn defaults() -> Vec<StructureSpec> {
    let mut all = Vec::new();
    for entry in registry::entries().iter().filter(|e| e.traits.built_in && e.traits.default) {
        let linear = entry.traits.linear;
        for kernel in KernelId::ALL.into_iter().filter(|kernel| !(linear && kernel.is_lossy())) {
            let spec = StructureSpec::plain(entry.id);
            all.push(spec.with_default("kernel", kernel));
        }
    }
    all.extend(registry::with_variants(|entry| !entry.traits.built_in));
    all
}

/// Measures and judges; `listener` hears of every scene and of the rays decided, `keep` is given the record whenever it has grown.
///
/// # Errors
/// A scene that is unsound; scenes that are merely not on this machine are skipped.
pub fn run(
    plan: &Plan,
    choices: &[Choice],
    mut listener: impl Listener,
    mut keep: impl FnMut(&Trade),
) -> Result<Trade, SceneError> {
    if rayon::current_num_threads() == 1 {
        registry::keep_to_one_thread();
    }
    let judges = rayon::ThreadPoolBuilder::new().num_threads(plan.judges).build();
    let mut trade = Trade {
        format: FORMAT,
        command: plan.command.clone(),
        suite: Suite::this(),
        machine: Machine::here(),
        tolerance: Tolerance::VISIBLE,
        scenes: Vec::new(),
        rows: Vec::new(),
        curve: Vec::new(),
        extremes: Vec::new(),
        leaving: Vec::new(),
        skipped: registry::absent()
            .into_iter()
            .map(|a| Skipped { id: a.id.to_owned(), reason: a.reason })
            .collect(),
    };
    for (i, id) in plan.scenes.iter().enumerate() {
        let spec: SceneSpec = id.parse()?;
        let loaded = match scenes::load_full(&spec) {
            Ok(loaded) => loaded,
            Err(error) if error.is_unavailable() => {
                listener.hear(&Event::SceneSkipped { id, reason: &error });
                trade.skipped.push(Skipped { id: id.clone(), reason: error.to_string() });
                continue;
            }
            Err(error) => return Err(error),
        };
        let Geometry::Triangles(mesh) = &loaded.scene.geometry else {
            trade.skipped.push(Skipped { id: id.clone(), reason: "only triangles have kernels".to_owned() });
            continue;
        };
        listener.hear(&Event::SceneBegun {
            id,
            place: i + 1,
            of: plan.scenes.len(),
            objects: mesh.triangles.len(),
            kind: loaded.scene.geometry.kind(),
        });
        trade.scenes.push(SceneEntry {
            id: loaded.scene.id.clone(),
            objects: mesh.triangles.len() as u64,
            kind: loaded.scene.geometry.kind().to_owned(),
            source: loaded.source.clone(),
            checksum: scenes::checksum(&loaded.scene.geometry),
        });
        let scene = &loaded.scene;
        let judge = Judge::new(scene, trade.tolerance);
        let mut work =
            Work { plan, scene, judge: &judge, judges: judges.as_ref().ok(), listener: &mut listener };
        let ordinary = work.decide(&plan.ordinary, plan.judged, &mut trade.skipped);
        let mut rows = work.rows(choices, &ordinary, &mut trade.skipped);
        mark_front(&mut rows);
        trade.rows.extend(rows);
        if plan.curve.contains(id) {
            let judges = work.judges;
            trade.curve.extend(curve::of(scene, &judge, &ordinary, &|task| on(judges, task)));
            trade.leaving.extend(on(judges, || leaving::of(scene, plan.hunting)));
        }
        keep(&trade);
    }
    if plan.extremes > 0 {
        let found = extremes::all(plan.extremes, plan.largest, plan.seed, &mut |id| {
            listener.hear(&Event::SceneChecked { id });
        });
        trade.extremes = found;
        keep(&trade);
    }
    Ok(trade)
}

/// Runs on the judges' threads, or here if they could not be had.
fn on<T: Send>(judges: Option<&rayon::ThreadPool>, task: impl FnOnce() -> T + Send) -> T {
    match judges {
        Some(pool) => pool.install(task),
        None => task(),
    }
}

/// A scene in work.
struct Work<'w, L> {
    plan: &'w Plan,
    scene: &'w Scene,
    judge: &'w Judge<'w>,
    judges: Option<&'w rayon::ThreadPool>,
    listener: &'w mut L,
}

impl<L: Listener> Work<'_, L> {
    fn make(&self, sets: &[RaysId], size: u32, skipped: &mut Vec<Skipped>) -> Vec<RayQuery> {
        let RayQueries { made, left_out } = workload::make(self.scene, sets, size, self.plan.seed);
        skipped.extend(left_out.iter().map(|(id, error)| Skipped::rays(&self.scene.id, id, error)));
        made
    }

    /// Ray sets with their exact answers, by all judges.
    fn decide(&mut self, sets: &[RaysId], size: u32, skipped: &mut Vec<Skipped>) -> Vec<Set> {
        let queries = self.make(sets, size, skipped);
        let (judge, judges) = (self.judge, self.judges);
        let mut all = Vec::new();
        for asked in &queries {
            let (rays, of) = (asked.id, asked.rays.len());
            // The listener stays on this thread: the judges report through a channel.
            let (send, receive) = std::sync::mpsc::channel();
            let set = std::thread::scope(|scope| {
                let working = scope.spawn(move || {
                    on(judges, || {
                        Set::decide(judge, asked, &mut |done| {
                            // Nobody is left to hear when the study was given up.
                            let _ = send.send(done);
                        })
                    })
                });
                for done in receive {
                    self.listener.hear(&Event::RaysDecided { rays, done, of });
                }
                working.join()
            });
            match set {
                Ok(set) => all.push(set),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    }

    fn rows(&mut self, choices: &[Choice], ordinary: &[Set], skipped: &mut Vec<Skipped>) -> Vec<TradeRow> {
        let (plan, scene) = (self.plan, self.scene);
        let hunting = self.decide(&HUNTING, plan.hunting, skipped);
        let timed = self.make(&plan.timed, plan.size, skipped);
        let choices = &*harness::auto::resolve(choices, scene, &batches(&timed));
        let deadline = Deadline::default();
        let job =
            Job { scene, queries: &timed, choices, options: &plan.options, known: &[], deadline: &deadline };
        let mut cells: Vec<Cell> = Vec::new();
        let listener = &mut *self.listener;
        measure(&job, |asked, pass, more| {
            cells.retain(|cell| cell.rays != asked.id.name());
            cells.extend(more);
            listener.hear(&Event::RaySetDone {
                rays: asked.id,
                pass: pass + 1,
                passes: plan.options.passes(),
            });
        });
        let mut rows = Vec::new();
        for choice in choices {
            let name = choice.spec.to_string();
            let mine: Vec<_> = cells.iter().filter(|cell| cell.structure == name).collect();
            let ns: Option<Vec<f64>> = mine.iter().map(|cell| cell.ns()).collect();
            let bytes = mine.iter().find_map(|cell| cell.bytes.as_ref());
            let failed = mine.iter().map(|c| &c.outcome).find(|o| !o.is_measured());
            let mut row = TradeRow {
                scene: scene.id.clone(),
                structure: name,
                kernel: choice.intersector(),
                kernel_reason: choice.reason().to_owned(),
                ns_per_ray: ns.as_deref().and_then(geometric_mean),
                bytes: bytes.map(|b| b.structure + b.geometry_copy),
                ordinary: None,
                hunting: None,
                sets: Vec::new(),
                accuracy: None,
                front: false,
                outcome: failed.cloned().unwrap_or_default(),
            };
            match on(self.judges, || judged(self.judge, choice, scene, &plan.options, [ordinary, &hunting])) {
                Ok(sorts) => {
                    let [ordinary, hunting] = sorts.map(|(sum, sets)| {
                        row.sets.extend(sets);
                        sum
                    });
                    (row.ordinary, row.hunting) = (Some(ordinary), Some(hunting));
                }
                Err(failure) => row.outcome = failure.into(),
            }
            rows.push(row);
        }
        rows
    }
}

type Sort = (Judged, Vec<Judged>);

/// A structure's answers to sorts of sets: the sum of each, and set by set.
fn judged(
    judge: &Judge,
    choice: &Choice,
    scene: &Scene,
    options: &Options,
    sorts: [&[Set]; 2],
) -> Result<[Sort; 2], Failure> {
    let accel = guarded_build(choice, scene, &Workload::GENERAL)?;
    let few = (options.linear_tests / scene.geometry.len().max(1) as u64).max(16) as usize;
    let one = |sets: &[Set]| -> Result<Sort, Failure> {
        let mut sum = Tally::default();
        let mut all = Vec::new();
        for set in sets {
            let fewer = choice.entry.traits.subsamples(&set.rays).then(|| set.fewer(few));
            let tally = guard("tracing", || fewer.as_ref().unwrap_or(set).judge(judge, accel.as_ref()))?;
            all.push(Judged::of(&set.name, tally.clone()));
            sum.extend(tally);
        }
        Ok((Judged::of("", sum), all))
    };
    Ok([one(sorts[0])?, one(sorts[1])?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trade(structures: &[&str]) -> Trade {
        let choices: Vec<_> = structures.iter().map(|id| registry::parse(id).unwrap()).collect();
        let plan = Plan {
            scenes: vec!["bumps-1k".into(), "unit-boxes".into()],
            timed: vec![RaysId::Random],
            size: 16,
            ordinary: ORDINARY.to_vec(),
            judged: 20,
            hunting: 24,
            curve: vec!["bumps-1k".into()],
            extremes: 0,
            largest: 0,
            judges: 2,
            seed: 1,
            options: Options { rounds: 1, least_rounds: 1, ..Options::default() },
            command: "test".into(),
        };
        run(&plan, &choices, (), |_| {}).unwrap()
    }

    #[test]
    fn the_exact_kernel_has_no_error_and_others_are_judged() {
        let trade =
            trade(&["ssm:kernel=exact", "ssm:kernel=watertight", "ssm:kernel=moller-trumbore", "obvhs-bvh2"]);
        let hunting: Vec<_> = trade.rows.iter().map(|row| row.hunting.clone().unwrap()).collect();
        for exact in [&hunting[0], trade.rows[0].ordinary.as_ref().unwrap()] {
            assert_eq!((exact.counts.visible(), exact.counts.swapped, exact.counts.ties), (0, 0, 0));
            assert!(exact.errors.t_ulps.largest <= 0.5 && exact.counts.rays >= 4 * 20 * 20);
            assert_eq!(exact.bounds.visible.high, 3.0 / exact.counts.rays as f64);
        }
        let leaks = |row: &TradeRow| {
            row.sets.iter().filter(|s| s.rays.starts_with("leak")).map(|s| s.counts.holes).sum::<u64>()
        };
        assert_eq!(leaks(&trade.rows[1]), 0);
        assert!(hunting[2].errors.t_ulps.largest > 0.5, "Möller–Trumbore rounds");
        assert!(trade.rows.iter().any(|row| row.front));
        assert!(trade.rows.iter().all(|row| row.sets.len() == ORDINARY.len() + HUNTING.len()));
        assert!(trade.skipped.iter().any(|s| s.id == "unit-boxes"));
        assert!(!trade.curve.is_empty() && !trade.leaving.is_empty());
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trade.json");
        std::fs::write(&path, serde_json::to_string(&trade).unwrap()).unwrap();
        let read = Trade::read(&path).unwrap();
        assert_eq!((read.rows, read.curve), (trade.rows, trade.curve));
    }

    /// Another object in the same place is nothing that shows.
    #[test]
    fn doubled_triangles_add_no_visible_error() {
        let single = scenes::load(&"bumps-1k@offset=1e4,0,0".parse().unwrap()).unwrap();
        let mut double = single.clone();
        if let Geometry::Triangles(mesh) = &mut double.geometry {
            mesh.triangles.extend_from_within(..);
        }
        let sets = workload::make(&single, &[RaysId::Edge, RaysId::Vertex, RaysId::Perspective], 20, 1).made;
        for structure in ["bmssm", "ssm", "minmax"] {
            for kernel in ["moller-trumbore", "baldwin-weber", "watertight", "double", "exact"] {
                let choice = registry::parse(&format!("{structure}:kernel={kernel}")).unwrap();
                let found = [&single, &double].map(|scene| {
                    let judge = Judge::new(scene, Tolerance::VISIBLE);
                    let accel = guarded_build(&choice, scene, &Workload::GENERAL).unwrap();
                    let mut sum = Tally::default();
                    for set in &sets {
                        sum.extend(Set::decide(&judge, set, &mut |_| {}).judge(&judge, accel.as_ref()));
                    }
                    sum.counts
                });
                assert_eq!(found[0].rays, 1200);
                assert!(found[1].visible() <= found[0].visible(), "{structure}, {kernel}: {found:?}");
            }
        }
    }

    #[test]
    fn records_of_old_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trade.json");
        let machine = serde_json::to_value(Machine::here()).unwrap();
        let suite = serde_json::to_value(Suite::this()).unwrap();
        let mut old = serde_json::json!({
            "command": "rayscale trade", "suite": suite, "machine": machine, "scenes": [], "skipped": [],
            "rows": [{
                "scene": "s", "structure": "ssm:kernel=double", "kernel": "double", "ns_per_ray": 10.0, "bytes": 5,
                "accuracy": {"rays": 1000, "missed": 1, "false_hits": 2, "wrong_object": 3, "leaks": 1, "t_ulp_max": 3e38},
                "front": true
            }]
        });
        std::fs::write(&path, old.to_string()).unwrap();
        let trade = Trade::read(&path).unwrap();
        assert_eq!((trade.format, trade.rows[0].point()), (1, Some((10.0, 6000.0))));
        old["format"] = 99.into();
        std::fs::write(&path, old.to_string()).unwrap();
        assert!(Trade::read(&path).unwrap_err().to_string().contains("format 99"));
    }
}
