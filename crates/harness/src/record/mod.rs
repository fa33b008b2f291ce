//! Records: everything a report needs, raw samples included, in one JSON file.

mod cell;
mod file;
mod intersector;
mod memory;
mod outcome;
mod run;
mod suite;

pub use cell::{Bytes, Cell, Check, Errors, Key, Timing, id_of};
pub use file::{Kind, RecordError, from_text, read, read_kind, to_text, write};
pub use intersector::Intersector;
pub use memory::{Layout, MemoryRow};
pub use outcome::Outcome;
pub use run::Run;
pub use scenes::rays::{Query, RaysId};
pub use suite::Suite;

use crate::machine::Machine;
use serde::{Deserialize, Serialize};

/// The form of records; raised when old readers could no longer read new records.
pub const FORMAT: u32 = 1;

/// A run of the suite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`FORMAT`] of the writer.
    pub format: u32,
    /// When the run began, in seconds since 1970 (UTC).
    pub started_unix: u64,
    /// The command that made it.
    pub command: String,
    /// The program.
    pub suite: Suite,
    /// Where it ran.
    pub machine: Machine,
    /// How it was asked for; none in records of old.
    #[serde(default)]
    pub run: Option<Run>,
    /// The structures measured, each with its settings.
    pub structures: Vec<Structure>,
    /// Scenes.
    pub scenes: Vec<SceneEntry>,
    /// What was measured.
    pub cells: Vec<Cell>,
    /// Memory of grids and bit maps by resolution.
    #[serde(default)]
    pub memory: Vec<MemoryRow>,
    /// Structures and scenes left out, with the reason.
    #[serde(default)]
    pub skipped: Vec<Skipped>,
}

/// A structure as measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// Its name in cells: id and the settings that were asked for.
    pub id: String,
    /// Version of the library behind it.
    pub version: String,
    /// All settings, given or by default.
    pub settings: String,
    /// What it is.
    pub description: String,
}

/// A scene as measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneEntry {
    /// Its name in cells.
    pub id: String,
    /// Number of objects.
    pub objects: u64,
    /// What kind of objects.
    pub kind: String,
    /// Generator and seed, or where the file comes from.
    pub source: String,
    /// SHA-256 of its geometry.
    pub checksum: String,
}

/// Something that was asked for and not done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Skipped {
    /// A structure's or scene's id.
    pub id: String,
    /// Why.
    pub reason: String,
}

impl Skipped {
    /// A ray set of a scene.
    pub fn rays(scene: &str, rays: &impl std::fmt::Display, reason: &impl std::fmt::Display) -> Self {
        Self { id: format!("{scene}/{rays}"), reason: reason.to_string() }
    }
}

impl Record {
    /// The scene of that name.
    pub fn scene(&self, id: &str) -> Option<&SceneEntry> {
        self.scenes.iter().find(|scene| scene.id == id)
    }

    /// How a structure came out on a ray set of a scene, whether it has a cell there or not.
    pub fn outcome(&self, scene: &str, rays: &str, structure: &str) -> Outcome {
        let here = |cell: &&Cell| (&*cell.scene, &*cell.rays, &*cell.structure) == (scene, rays, structure);
        if let Some(cell) = self.cells.iter().find(here) {
            return cell.outcome.clone();
        }
        let set = Skipped::rays(scene, &rays, &"").id;
        match self.skipped.iter().find(|skipped| [scene, &*set, structure].contains(&&*skipped.id)) {
            Some(skipped) => Outcome::Skipped(skipped.reason.clone()),
            None => Outcome::Unsupported(format!("does not serve {rays} rays")),
        }
    }

    /// Names of the structures that have cells, in the record's order.
    pub fn structure_ids(&self) -> Vec<&str> {
        self.structures.iter().map(|structure| structure.id.as_str()).collect()
    }

    /// Names of the ray sets, in the order in which they first appear.
    pub fn ray_sets(&self) -> Vec<&str> {
        let mut all: Vec<&str> = Vec::new();
        for cell in &self.cells {
            if !all.contains(&cell.rays.as_str()) {
                all.push(&cell.rays);
            }
        }
        all
    }
}
