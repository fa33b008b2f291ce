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
                let block = &self.blocks[at];
                // Wraps to a number beyond the block's slices where the pixel lies before them.
                let (r, c) = (row.wrapping_sub(block.row), col.wrapping_sub(block.col));
                if r >= block.rows || c >= block.cols {
                    continue;
                }
                let words = &self.words[block.words as usize..];
                let mut candidates = words[r as usize] & words[(block.rows + c) as usize];
                while candidates != 0 {
                    found.push(self.geometry.object(at * BLOCK + candidates.trailing_zeros() as usize));
                    candidates &= candidates - 1;
                }
            }
        }
    }
}
