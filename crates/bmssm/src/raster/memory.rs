//! What the maps of one image take, and what building them takes.

use super::maps::Block;
use super::order::Shown;
use super::{Settings, THICKNESS};
use crate::id::{ID, UNCOUNTED};
use accel::{BuildError, Raster};
use lanes::BLOCK;

/// Bytes of an image's maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bytes {
    /// Once they are built.
    pub held: u128,
    /// At any moment of building them.
    pub peak: u128,
}

impl Bytes {
    /// As many as anything may take.
    #[cfg(test)]
    pub const ANY: Self = Self { held: u128::MAX, peak: u128::MAX };

    /// Holds them against what is allowed.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`]
    pub fn check(self, allowed: Self) -> Result<(), BuildError> {
        if self.held <= allowed.held && self.peak <= allowed.peak {
            return Ok(());
        }
        let bytes = self.held.max(self.peak);
        Err(BuildError::TooLarge { structure: ID.into(), bytes, limit: allowed.peak })
    }
}

/// What maps are made for.
#[derive(Clone, Copy)]
pub(super) struct Image<'a> {
    pub raster: &'a Raster,
    pub settings: &'a Settings,
    /// Objects there are, and those of them that are shown.
    pub objects: usize,
    pub shown: usize,
    /// Bytes of the shown objects' geometry.
    pub copy: u128,
}

impl Image<'_> {
    /// The slices of all rows and of all columns.
    fn slices(&self) -> usize {
        let slices = |pixels: u32| pixels.div_ceil(THICKNESS) as usize;
        slices(self.raster.rows) + slices(self.raster.cols)
    }

    /// Words of the maps at most: as if each object were as large as the image.
    pub fn max_words(&self) -> usize {
        self.shown.div_ceil(BLOCK).saturating_mul(self.slices())
    }

    /// What maps of so many words take, built by the current threads.
    pub fn bytes(&self, words: usize) -> Bytes {
        let Self { objects, shown, copy, .. } = *self;
        let blocks = shown.div_ceil(BLOCK);
        let ids = blocks * BLOCK * size_of::<u32>();
        let words = words as u128 * 8;
        let headers = (blocks * size_of::<Block>()) as u128;
        // A bit per block for each row and column of tiles.
        let tiles = self.slices() / self.settings.tile as usize + 4;
        let tiles = (tiles * blocks.div_ceil(64) * 8) as u128;
        let seen = (shown * size_of::<Shown>()) as u128;
        let joining = (objects * size_of::<Shown>()) as u128 + seen;
        let keys = shown * size_of::<u64>();
        let sorting = seen + (keys + accel::keys::sort_bytes(shown, accel::parallel::threads())) as u128;
        // Headers in each part, which grow by doubling, then in both orders; words in each part and joined.
        let registering = seen + (keys + 2 * ids) as u128 + 4 * headers + 2 * words;
        let held = headers + words + tiles + copy;
        let packing = held + ids as u128;
        Bytes { held, peak: joining.max(sorting).max(registering).max(packing) + UNCOUNTED }
    }
}
