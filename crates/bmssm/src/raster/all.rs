//! All that a pixel may show, however far away.

use super::{RasterMaps, THICKNESS};
use lanes::{BLOCK, Blocks, PackedObjects};

impl<O: PackedObjects> RasterMaps<O> {
    /// Appends all candidates of a pixel.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub(super) fn gather(&self, row: u32, col: u32, found: &mut Vec<u32>) {
        let (row, col) = (row / THICKNESS, col / THICKNESS);
        let across = self.settings.tile;
        for (i, (r, c)) in self.tiles.of(row / across, col / across).enumerate() {
            let mut seen = r & c;
            while seen != 0 {
                let at = i * 64 + seen.trailing_zeros() as usize;
                seen &= seen - 1;
                let mut candidates = self.candidates(at, row, col);
                while candidates != 0 {
                    found.push(self.geometry.object(at * BLOCK + candidates.trailing_zeros() as usize));
                    candidates &= candidates - 1;
                }
            }
        }
    }
}
