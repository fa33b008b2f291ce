//! Why there is no reproduction.

use accel::BuildError;
use scenes::SceneError;

/// Why the paper can't be reproduced.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// A scene that can't be had.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A structure that can't be built.
    #[error(transparent)]
    Build(#[from] BuildError),
}
