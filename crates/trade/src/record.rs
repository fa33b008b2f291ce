//! The record of a trade as a file.

use crate::TradeRow;
use crate::curve::Precise;
use crate::extremes::Extreme;
use crate::leaving::Leaving;
use harness::machine::Machine;
use harness::record::{Kind, RecordError, SceneEntry, Skipped, Suite, read_kind};
use judge::Tolerance;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The form of records. Those of form 1, which say none, have one rate for ordinary and hunting rays.
pub const FORMAT: u32 = 2;

/// Everything that the tables, the conclusions and the plots are made from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Trade {
    /// [`FORMAT`] of the writer.
    #[serde(default = "first")]
    pub format: u32,
    /// The command that made it.
    pub command: String,
    /// The program.
    pub suite: Suite,
    /// Where it ran.
    pub machine: Machine,
    /// What a hit may be off, as a fraction of the scene's extent.
    #[serde(default)]
    pub tolerance: Tolerance,
    /// Scenes.
    pub scenes: Vec<SceneEntry>,
    /// A row for each structure and kernel on each scene.
    pub rows: Vec<TradeRow>,
    /// The curve of precision.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curve: Vec<Precise>,
    /// The extremes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub extremes: Vec<Extreme>,
    /// Rays that leave surfaces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub leaving: Vec<Leaving>,
    /// Scenes and ray sets left out, with the reason.
    pub skipped: Vec<Skipped>,
}

const fn first() -> u32 {
    1
}

const KIND: Kind = Kind {
    of: "`rayscale trade`",
    example: "a trade.json that `rayscale trade` wrote",
    format: FORMAT,
    unsaid: Some(first()),
};

impl Trade {
    /// Reads a record, of old or new.
    ///
    /// # Errors
    /// Files that can't be read, are no record, or are of a later form.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        read_kind(path, KIND)
    }
}
