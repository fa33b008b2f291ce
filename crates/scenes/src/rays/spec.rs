//! A ray set with its size and seed.

use super::id::{RaysError, RaysId};
use accel::{Hit, Ray};

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

    /// Holds what the rays take, and the hits of two structures that are compared, against the memory there is.
    ///
    /// # Errors
    /// [`RaysError::TooLarge`]
    pub(super) fn check_memory(&self) -> Result<(), RaysError> {
        let count = u128::from(self.rows) * u128::from(self.cols);
        let bytes = count * (size_of::<Ray>() + 2 * size_of::<Option<Hit>>()) as u128;
        let available = accel::available_memory();
        if bytes > available {
            return Err(RaysError::TooLarge { rays: self.id, count, bytes, available });
        }
        Ok(())
    }
}
