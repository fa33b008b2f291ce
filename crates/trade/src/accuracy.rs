//! Errors as records of old have them.

use serde::{Deserialize, Serialize};

/// Errors over a mixture of ordinary sets and such as hunt for errors; read from records of old, never written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Rays judged.
    pub rays: u64,
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub false_hits: u64,
    /// A hit of another object than the nearest, wherever it lies.
    pub wrong_object: u64,
}

impl Accuracy {
    /// Wrong answers of any kind in a million rays.
    pub fn errors_per_million(&self) -> f64 {
        (self.missed + self.false_hits + self.wrong_object) as f64 * 1e6 / self.rays.max(1) as f64
    }
}
