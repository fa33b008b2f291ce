//! The structures, a file for each family of them.

mod built_in;
mod embree;
mod obvhs;

pub use embree::keep_to_one_thread;

use super::Entry;

/// The families in the order of reports.
pub const FAMILIES: [&[Entry]; 3] = [built_in::ENTRIES, obvhs::ENTRIES, embree::ENTRIES];
