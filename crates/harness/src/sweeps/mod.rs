//! Whether structures lose or invent hits, and whether kernels keep what they promise, over many scenes and rays.

pub mod differences;
pub mod leaks;
pub mod oracle;

use scenes::SceneError;

/// What is said of a scene that is not on this machine.
fn unavailable(error: &SceneError) -> String {
    format!("passed over: {error}")
}
