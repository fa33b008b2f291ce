//! Building what may refuse or panic.

use super::Choice;
use crate::guard::{Panicked, guard};
use accel::{Accel, BuildError, Cancel, Scene, Workload};

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
    /// Whether the structure merely has no way to serve the scene or the workload.
    pub fn is_unsupported(&self) -> bool {
        matches!(self, Self::Refused(BuildError::Unsupported { .. }))
    }

    /// Whether there is merely not enough memory.
    pub fn is_too_large(&self) -> bool {
        matches!(self, Self::Refused(BuildError::TooLarge { .. }))
    }

    /// Whether the build was asked to end.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Refused(BuildError::Cancelled { .. }))
    }
}

/// Builds; a panic of the builder is an error as well.
///
/// # Errors
/// What the builder refuses, and what it panics with.
pub fn guarded_build<'s>(
    choice: &Choice,
    scene: &'s Scene,
    workload: &Workload,
) -> Result<Box<dyn Accel + 's>, BuildFailure> {
    guarded_build_unless(choice, scene, workload, Cancel::NEVER)
}

/// [`guarded_build`] that gives up soon after it is asked to.
///
/// # Errors
/// Those of [`guarded_build`], and [`BuildError::Cancelled`].
pub fn guarded_build_unless<'s>(
    choice: &Choice,
    scene: &'s Scene,
    workload: &Workload,
    cancel: Cancel,
) -> Result<Box<dyn Accel + 's>, BuildFailure> {
    Ok(guard("the build", || choice.builder.build_unless(scene, workload, cancel))??)
}
