//! Building what may refuse or panic.

use super::Choice;
use crate::guard::{Panicked, guard};
use accel::{Accel, BuildError, Need, Scene};

/// Why there is no structure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildFailure {
    /// The builder refused.
    #[error(transparent)]
    Refused(#[from] BuildError),
    /// The builder panicked.
    #[error(transparent)]
    Panicked(#[from] Panicked),
}

impl BuildFailure {
    /// Whether the structure merely has no way to serve the scene or the need.
    pub fn is_unsupported(&self) -> bool {
        matches!(self, Self::Refused(BuildError::Unsupported { .. }))
    }
}

/// Builds; a panic of the builder is an error as well.
///
/// # Errors
/// What the builder refuses, and what it panics with.
pub fn guarded_build<'s>(
    choice: &Choice,
    scene: &'s Scene,
    need: &Need,
) -> Result<Box<dyn Accel + 's>, BuildFailure> {
    Ok(guard("the build", || choice.builder.build(scene, need))??)
}
