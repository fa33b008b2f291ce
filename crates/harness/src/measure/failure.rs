//! Why a cell has no figures.

use crate::guard::Panicked;
use crate::record::Outcome;
use crate::registry::BuildFailure;

/// Why a cell has no figures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// There is no structure.
    #[error(transparent)]
    Build(#[from] BuildFailure),
    /// The structure panicked.
    #[error(transparent)]
    Panicked(#[from] Panicked),
    /// A built-in structure is broken.
    #[error("{differences} of {rays} rays differ from brute force")]
    Differs {
        /// Rays that differ.
        differences: u64,
        /// Rays compared.
        rays: u64,
    },
    /// A built-in structure depends on more than its input.
    #[error("another build of the structure gave other answers than the one that was checked")]
    OtherBuild,
    /// A sample was wrong.
    #[error("ray {ray} of a timed trace has another answer than in the checked trace")]
    Changed {
        /// The ray's number.
        ray: usize,
    },
}

impl From<Failure> for Outcome {
    fn from(failure: Failure) -> Self {
        match &failure {
            Failure::Build(build) if build.is_unsupported() => Self::Unsupported(failure.to_string()),
            _ => Self::Failed(failure.to_string()),
        }
    }
}
