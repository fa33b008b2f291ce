//! What is to be measured on a scene, and what of it is there already.

use super::{Deadline, Options};
use crate::record::Cell;
use crate::registry::Choice;
use crate::workload::RayQuery;
use accel::Scene;

/// What is to be measured on a scene.
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Ray sets.
    pub queries: &'a [RayQuery],
    /// Structures.
    pub choices: &'a [Choice],
    /// How much.
    pub options: &'a Options,
    /// Cells of the scene that are there already, with all their passes or some.
    pub known: &'a [Cell],
    /// When to stop.
    pub deadline: &'a Deadline,
}

impl Job<'_> {
    /// Whether a cell is to be measured in a pass: it is not there already.
    pub fn wants(&self, asked: &RayQuery, choice: &Choice, pass: usize) -> bool {
        self.known(asked, choice).is_none_or(|cell| cell.outcome.is_measured() && cell.passes.len() <= pass)
    }

    /// Whether any pass wants a cell.
    pub fn lacks(&self, asked: &RayQuery, choice: &Choice) -> bool {
        (0..self.options.passes()).any(|pass| self.wants(asked, choice, pass))
    }

    /// The cell as an earlier run left it.
    pub fn known(&self, asked: &RayQuery, choice: &Choice) -> Option<&Cell> {
        let name = choice.spec.to_string();
        self.known.iter().find(|cell| cell.rays == asked.id.name() && cell.structure == name)
    }
}
