//! All that a pixel may show, however far away.

use super::{RasterMaps, THICKNESS};
use lanes::{BLOCK, Blocks, PackedObjects, ones};

impl<O: PackedObjects> RasterMaps<O> {
    /// Appends all candidates of a pixel.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub(super) fn gather(&self, row: u32, col: u32, found: &mut Vec<u32>) {
        let (row, col) = (row / THICKNESS, col / THICKNESS);
        let across = self.settings.tile;
        for (i, (r, c)) in self.tiles.of(row / across, col / across).enumerate() {
            for at in ones(r & c).map(|bit| i * 64 + bit) {
                let candidates = ones(self.candidates(at, row, col));
                found.extend(candidates.map(|bit| self.geometry.object(at * BLOCK + bit)));
            }
        }
    }
}
