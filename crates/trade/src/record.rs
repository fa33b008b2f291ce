//! The record of a trade as a file.

use crate::Row;
use crate::curve::Precise;
use crate::extremes::Extreme;
use crate::leaving::Leaving;
use harness::machine::Machine;
use harness::record::{SceneEntry, Skipped, Suite};
use judge::Tolerance;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

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
    pub rows: Vec<Row>,
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

fn first() -> u32 {
    1
}

/// Why there is no record to be had from a file.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file can't be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file holds no record of a trade.
    #[error("{}, line {}, column {}: not a record of `rayscale trade`: {source}", path.display(), source.line(), source.column())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// A record of a later form.
    #[error("{}: a record of format {found}; this program reads up to format {FORMAT}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u32,
    },
}

impl Trade {
    /// Reads a record, of old or new.
    ///
    /// # Errors
    /// Files that can't be read, are no record, or are of a later form.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let io = |source| ReadError::Io { path: path.to_owned(), source };
        let syntax = |source| ReadError::Syntax { path: path.to_owned(), source };
        let text = std::fs::read_to_string(path).map_err(io)?;
        #[derive(Deserialize)]
        struct Head {
            #[serde(default = "first")]
            format: u32,
        }
        let Head { format } = serde_json::from_str(&text).map_err(syntax)?;
        if format > FORMAT {
            return Err(ReadError::Format { path: path.to_owned(), found: format });
        }
        serde_json::from_str(&text).map_err(syntax)
    }
}
