//! Kinds of error.

use serde::{Deserialize, Serialize};

/// What an answer that is not the exact one does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The nearest surface is missed: nothing is reported, or something farther by more than the tolerance.
    Hole,
    /// A hit where there is none, or nearer than the nearest surface by more than the tolerance.
    Phantom,
    /// The surface that the ray truly hits, at a place that is off by more than the tolerance.
    Displaced,
    /// Another object, within the tolerance of the true place: harmless unless it matters which object it is.
    Swapped,
    /// Another object that the ray hits at exactly the same t: as true an answer as the one with the lower number.
    Tie,
}

impl Kind {
    /// All kinds, the worst first.
    pub const ALL: [Self; 5] = [Self::Hole, Self::Phantom, Self::Displaced, Self::Swapped, Self::Tie];

    /// Those that show in a picture.
    pub const VISIBLE: [Self; 3] = [Self::Hole, Self::Phantom, Self::Displaced];

    /// What many of them are called.
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Hole => "holes",
            Self::Phantom => "phantoms",
            Self::Displaced => "displaced",
            Self::Swapped => "swapped",
            Self::Tie => "ties",
        }
    }
}
