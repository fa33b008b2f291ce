//! A question of the tree.

use super::subject::{Subject, Verdict};

/// A question.
#[derive(Clone, Copy)]
pub struct Group {
    /// Its place in the tree, parted by `/`.
    pub name: &'static str,
    /// What it asks, in a few words.
    pub about: &'static str,
    pub(super) ask: fn(&Subject) -> Verdict,
}
