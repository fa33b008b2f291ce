//! What is stored: a header and words for each block, a bit per block for each row and column of tiles.

use crate::id::ID;
use accel::BuildError;
use lanes::ROW;

/// Slots that share a bound of depth.
pub(super) const GROUP: usize = ROW;
/// Such groups in a block.
pub(super) const GROUPS: usize = lanes::BLOCK / GROUP;

/// Header of a block of 64 objects. Its words lie side by side: R of its rows' slices, then
/// S of its columns'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    /// Index of the first word.
    pub words: u32,
    /// First slice of rows.
    pub row: u32,
    /// Slices of rows.
    pub rows: u32,
    /// First slice of columns.
    pub col: u32,
    /// Slices of columns.
    pub cols: u32,
    /// Lower bound of the t of any hit on the objects of each group; never falls from group to group.
    pub depth: [f32; GROUPS],
    /// Cells where slices of an object meet, summed over the objects.
    pub cells: u32,
}

impl Block {
    /// Words of R and S.
    pub fn len(&self) -> usize {
        (self.rows + self.cols) as usize
    }
}

/// The upper maps: for each row and each column of tiles a bit per block.
#[derive(Clone, Debug, Default)]
pub(super) struct TileMaps {
    rows: Vec<u64>,
    cols: Vec<u64>,
    /// Words of one map.
    words: usize,
}

impl TileMaps {
    /// The maps of `blocks` for so many rows and columns of tiles of `tile` slices.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory.
    pub fn new(blocks: &[Block], rows: u32, cols: u32, tile: u32) -> Result<Self, BuildError> {
        let words = blocks.len().div_ceil(64);
        let zeros = |slices: u32| accel::zeroed(ID, words * slices as usize);
        let mut maps = Self { rows: zeros(rows)?, cols: zeros(cols)?, words };
        for (i, block) in blocks.iter().enumerate() {
            let (word, bit) = (i / 64, 1 << (i % 64));
            for row in block.row / tile..(block.row + block.rows).div_ceil(tile) {
                maps.rows[row as usize * words + word] |= bit;
            }
            for col in block.col / tile..(block.col + block.cols).div_ceil(tile) {
                maps.cols[col as usize * words + word] |= bit;
            }
        }
        Ok(maps)
    }

    /// Words of R and S, side by side, of the tile in this row and column.
    #[inline(always)]
    pub fn of(&self, row: u32, col: u32) -> impl Iterator<Item = (u64, u64)> {
        let at = |i: u32| i as usize * self.words..(i as usize + 1) * self.words;
        let (r, s) = (at(row), at(col));
        self.rows[r].iter().copied().zip(self.cols[s].iter().copied())
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        accel::vec_bytes(&self.rows) + accel::vec_bytes(&self.cols)
    }
}
