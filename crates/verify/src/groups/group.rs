//! A question of the tree.

use super::subject::{Subject, Verdict};
use crate::cases::Reach;

/// A scene of size 1 about the origin of coordinates, and rays from near it.
pub(super) const CLOSE: Reach = Reach { scale: 0, offset: None, origins: 1 };

/// A question.
#[derive(Clone, Copy)]
pub struct Group {
    /// Its place in the tree, parted by `/`.
    pub name: &'static str,
    /// What it asks, in a few words.
    pub about: &'static str,
    pub(super) ask: fn(&Subject) -> Verdict,
}
