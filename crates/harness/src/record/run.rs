//! How a record's figures were asked for.

use crate::clock::Clock;
use serde::{Deserialize, Serialize};

/// What was asked for besides scenes, ray sets and structures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Run {
    /// Rows and columns of rasters; lists have as many rays.
    pub size: u32,
    /// Seed of lists of rays.
    pub seed: u64,
    /// Threads that built and traced.
    pub threads: usize,
    /// What the time of a sample is.
    pub clock: Clock,
    /// Most samples of a cell.
    pub rounds: usize,
    /// Whether steps were counted.
    pub counters: bool,
    /// Whether the run came to its end; if not, it was interrupted, and what is there is sound.
    pub complete: bool,
}
