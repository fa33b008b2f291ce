//! A ray set with its size and seed.

use super::id::RaysId;

/// A ray set to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RaysSpec {
    /// Which.
    pub id: RaysId,
    /// Rows of an image; a list has rows × cols rays.
    pub rows: u32,
    /// Columns of an image.
    pub cols: u32,
    /// Seed of a list's random numbers.
    pub seed: u64,
}

impl RaysSpec {
    /// Number of rays.
    pub fn count(&self) -> usize {
        self.rows as usize * self.cols as usize
    }
}
