//! Building what may refuse or panic.

use super::Choice;
use crate::guard::guard;
use accel::{Accel, Need, Scene};

/// Builds; what the builder refuses and what it panics with are both told in words.
pub fn guarded_build<'s>(
    choice: &Choice,
    scene: &'s Scene,
    need: &Need,
) -> Result<Box<dyn Accel + 's>, String> {
    guard("the build", || choice.builder.build(scene, need))
        .and_then(|built| built.map_err(|e| e.to_string()))
}
