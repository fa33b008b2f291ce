//! What accuracy costs: time and memory beside errors decided by exact arithmetic, for every
//! structure and kernel on the same rays.

mod accuracy;
mod row;

pub use accuracy::{Accuracy, Truth, judge};
pub use row::{Row, mark_front};

use crate::check::oracle_of;
use crate::guard::guard;
use crate::machine::Machine;
use crate::measure::{Failure, Job, Options, Watch, measure};
use crate::progress::{Event, Listener};
use crate::record::{Cell, SceneEntry, Skipped, Suite};
use crate::registry::{self, Choice, StructureSpec, guarded_build};
use crate::stats::geometric_mean;
use crate::workload::{self, Workload, Workloads, batches};
use accel::{Geometry, Need, Scene};
use oracle::Oracle;
use primitives::KernelId;
use scenes::rays::RaysId;
use scenes::{SceneError, SceneSpec};
use serde::Serialize;

/// The ray sets that are judged: ordinary ones, and those that hunt for errors.
pub const JUDGED: [RaysId; 9] = [
    RaysId::Random,
    RaysId::Diffuse,
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
    /// Rows and columns of the sets that are judged: each has their product of rays.
    pub judged: u32,
    /// Seed of lists of rays.
    pub seed: u64,
    /// How much is measured.
    pub options: Options,
    /// The command as given.
    pub command: String,
}

/// Everything that the table and the plot are made from.
#[derive(Clone, Debug, Serialize)]
pub struct Trade {
    /// The command that made it.
    pub command: String,
    /// The program.
    pub suite: Suite,
    /// Where it ran.
    pub machine: Machine,
    /// Scenes.
    pub scenes: Vec<SceneEntry>,
    /// A row for each structure and kernel on each scene.
    pub rows: Vec<Row>,
    /// Scenes and ray sets left out, with the reason.
    pub skipped: Vec<Skipped>,
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
    all.extend(registry::with_variants(|entry| !entry.traits.built_in && entry.traits.lists));
    all
}

/// Measures and judges; `listener` hears of every scene.
///
/// # Errors
/// A scene that is unsound; scenes that are merely not on this machine are skipped.
pub fn run(plan: &Plan, choices: &[Choice], mut listener: impl Listener) -> Result<Trade, SceneError> {
    if rayon::current_num_threads() == 1 {
        registry::keep_to_one_thread();
    }
    let mut trade = Trade {
        command: plan.command.clone(),
        suite: Suite::this(),
        machine: Machine::here(),
        scenes: Vec::new(),
        rows: Vec::new(),
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
        let oracle = oracle_of(&loaded.scene);
        let mut rows = one_scene(plan, &loaded.scene, choices, &oracle, &mut trade.skipped);
        mark_front(&mut rows);
        trade.rows.extend(rows);
    }
    Ok(trade)
}

fn one_scene(
    plan: &Plan,
    scene: &Scene,
    choices: &[Choice],
    oracle: &Oracle,
    skipped: &mut Vec<Skipped>,
) -> Vec<Row> {
    let mut make = |sets: &[RaysId], size| {
        let Workloads { made, left_out } = workload::make(scene, sets, size, plan.seed);
        skipped.extend(left_out.iter().map(|(id, error)| Skipped::rays(&scene.id, id, error)));
        made
    };
    let timed = make(&plan.timed, plan.size);
    let judged = make(&JUDGED, plan.judged);
    let choices = &*crate::auto::resolve(choices, scene, &batches(&judged));
    let watch = Watch::default();
    let job = Job { scene, workloads: &timed, choices, options: &plan.options, known: &[], watch: &watch };
    let mut cells: Vec<Cell> = Vec::new();
    measure(&job, |workload, _, more| {
        cells.retain(|cell| cell.rays != workload.id.name());
        cells.extend(more);
    });
    let truths: Vec<(&Workload, Truth)> = judged.iter().map(|w| (w, Truth::of(oracle, &w.rays))).collect();
    let extent = scene.geometry.bounds().extent().max_element();
    let mut rows = Vec::new();
    for choice in choices {
        let name = choice.spec.to_string();
        let mine: Vec<_> = cells.iter().filter(|cell| cell.structure == name).collect();
        let ns: Option<Vec<f64>> = mine.iter().map(|cell| cell.ns()).collect();
        let bytes = mine.iter().find_map(|cell| cell.bytes.as_ref());
        let mut row = Row {
            scene: scene.id.clone(),
            structure: name,
            kernel: choice.intersector(),
            kernel_reason: choice.reason().to_owned(),
            ns_per_ray: ns.as_deref().and_then(geometric_mean),
            bytes: bytes.map(|b| b.structure + b.geometry_copy),
            accuracy: None,
            front: false,
            outcome: mine.iter().map(|c| &c.outcome).find(|o| !o.is_measured()).cloned().unwrap_or_default(),
        };
        match accuracy(choice, scene, &truths, extent) {
            Ok(accuracy) => row.accuracy = Some(accuracy),
            Err(failure) => row.outcome = failure.into(),
        }
        rows.push(row);
    }
    rows
}

fn accuracy(
    choice: &Choice,
    scene: &Scene,
    truths: &[(&Workload, Truth)],
    extent: f32,
) -> Result<Accuracy, Failure> {
    let accel = guarded_build(choice, scene, &Need::GENERAL)?;
    Ok(guard("tracing", || judge(accel.as_ref(), truths, extent))?)
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
            judged: 24,
            seed: 1,
            options: Options { rounds: 1, least_rounds: 1, ..Options::default() },
            command: "test".into(),
        };
        run(&plan, &choices, ()).unwrap()
    }

    #[test]
    fn the_exact_kernel_has_no_error_and_others_are_judged() {
        let trade =
            trade(&["ssm:kernel=exact", "ssm:kernel=watertight", "ssm:kernel=moller-trumbore", "obvhs-bvh2"]);
        let accuracy: Vec<_> = trade.rows.iter().map(|row| row.accuracy.clone().unwrap()).collect();
        assert_eq!(accuracy[0].errors_per_million(), 0.0);
        assert!(accuracy[0].t_ulp_max <= 0.5 && accuracy[0].rays >= 8 * 24 * 24);
        assert_eq!(accuracy[1].leaks_per_million(), 0.0);
        assert!(accuracy[2].t_ulp_max > 0.5, "Möller–Trumbore rounds");
        assert!(trade.rows.iter().any(|row| row.front));
        assert!(trade.skipped.iter().any(|s| s.id == "unit-boxes"));
    }
}
