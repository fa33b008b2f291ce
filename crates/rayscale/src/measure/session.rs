//! A whole run: scenes by name to a record.

use super::Options;
use super::memory::{RESOLUTIONS, memory_rows};
use super::scene::{Job, measure};
use crate::machine::Machine;
use crate::rays::{self, RaysId, RaysSpec};
use crate::rayset::Workload;
use crate::record::{FORMAT, Query, Record, SceneEntry, Skipped, Structure, Suite};
use crate::registry::{self, Choice};
use crate::scene::{self, SceneError, SceneSpec};
use accel::{Accel, Need, Scene};
use std::time::{Duration, Instant, SystemTime};

/// What is to be measured.
#[derive(Clone, Debug)]
pub struct Session {
    /// Scenes by name.
    pub scenes: Vec<String>,
    /// Ray sets.
    pub rays: Vec<RaysId>,
    /// Rows and columns of rasters; lists have as many rays.
    pub size: u32,
    /// Seed of lists.
    pub seed: u64,
    /// How much is measured.
    pub options: Options,
    /// Whether memory by resolution is recorded.
    pub memory: bool,
    /// After so long no new scene begins, what is left is recorded as skipped, and the samples of a cell get
    /// shorter time.
    pub most_time: Option<Duration>,
    /// The command as given.
    pub command: String,
}

/// Measures. `tell` gets a line for every scene and ray set; `keep` gets the record as it is after every
/// scene, measured or skipped. What can't be done is in the record with its reason.
///
/// # Errors
/// A scene that is unsound; scenes that are merely not on this machine are skipped.
pub fn run(
    session: &Session,
    choices: &[Choice],
    mut tell: impl FnMut(&str),
    mut keep: impl FnMut(&Record),
) -> Result<Record, SceneError> {
    let start = Instant::now();
    let mut record = blank(session, choices);
    let mut options = session.options.clone();
    if let Some(most) = session.most_time {
        // Builds, checks and memory take several times as long as the samples.
        let cells = session.scenes.len() * session.rays.len() * choices.len();
        let share = most / cells.max(1) as u32;
        options.cell_time = options.cell_time.min(share.mul_f64(0.2));
        options.sample_time = options.sample_time.min(share / 2);
        options.build_time = options.build_time.min(4 * options.cell_time);
    }
    for (i, id) in session.scenes.iter().enumerate() {
        let spec: SceneSpec = id.parse()?;
        let loaded = match scene::load_full(&spec) {
            Ok(loaded) => loaded,
            Err(error) if error.is_unavailable() => {
                tell(&format!("{id}: skipped: {error}"));
                record.skipped.push(Skipped { id: id.clone(), reason: error.to_string() });
                keep(&record);
                continue;
            }
            Err(error) => return Err(error),
        };
        let scene = &loaded.scene;
        if session.most_time.is_some_and(|most| start.elapsed() >= most) {
            record.skipped.push(Skipped { id: scene.id.clone(), reason: "the time was up".to_owned() });
            keep(&record);
            continue;
        }
        tell(&format!(
            "{} ({} of {}): {} {}",
            scene.id,
            i + 1,
            session.scenes.len(),
            crate::units::count(scene.geometry.len() as u64),
            scene.geometry.kind()
        ));
        record.scenes.push(SceneEntry {
            id: scene.id.clone(),
            objects: scene.geometry.len() as u64,
            kind: scene.geometry.kind().to_owned(),
            source: loaded.source.clone(),
            checksum: scene::checksum(&scene.geometry),
        });
        let workloads = workloads(session, scene, &mut record.skipped);
        let job = Job { scene, workloads: &workloads, choices, options: &options };
        record.cells.extend(measure(&job, |rays| tell(&format!("  {rays}"))));
        if session.memory {
            record.memory.extend(memory_rows(scene, &RESOLUTIONS));
        }
        keep(&record);
    }
    Ok(record)
}

fn blank(session: &Session, choices: &[Choice]) -> Record {
    let structure = |choice: &Choice| Structure {
        id: choice.spec.to_string(),
        version: (choice.entry.version)(),
        settings: choice.builder.settings(),
        description: choice.entry.description.to_owned(),
    };
    let absent = registry::absent().into_iter();
    Record {
        format: FORMAT,
        started_unix: SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |t| t.as_secs()),
        command: session.command.clone(),
        suite: Suite::this(),
        machine: Machine::here(),
        structures: choices.iter().map(structure).collect(),
        scenes: Vec::new(),
        cells: Vec::new(),
        memory: Vec::new(),
        skipped: absent.map(|a| Skipped { id: a.id.to_owned(), reason: a.reason }).collect(),
    }
}

/// The ray sets of a scene; one that has no rays there is skipped.
pub fn workloads(session: &Session, scene: &Scene, skipped: &mut Vec<Skipped>) -> Vec<Workload> {
    let tracer = tracer_of(scene);
    let mut all = Vec::new();
    for id in &session.rays {
        let spec = RaysSpec { id: *id, rows: session.size, cols: session.size, seed: session.seed };
        let query = match id.query() {
            rays::Query::Closest => Query::Closest,
            rays::Query::Occlusion => Query::Occluded,
        };
        match rays::generate(scene, &spec, tracer.as_ref()) {
            Ok(rays) => all.push(Workload { id: id.to_string(), rays, query }),
            Err(error) => {
                skipped.push(Skipped { id: format!("{}/{id}", scene.id), reason: error.to_string() })
            }
        }
    }
    all
}

/// Something quick that answers what brute force would, for rays that start from hits.
fn tracer_of(scene: &Scene) -> Box<dyn Accel + '_> {
    let grid =
        registry::parse("ssm").ok().and_then(|choice| choice.builder.build(scene, &Need::GENERAL).ok());
    grid.unwrap_or_else(|| {
        let brute = registry::parse("brute").expect("brute force is an entry");
        brute.builder.build(scene, &Need::GENERAL).expect("brute force serves every scene")
    })
}
