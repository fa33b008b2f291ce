//! The fast BMSSM for the primary rays of one image (Skala 1993, §2, §4), in two levels.
//!
//! A slice is [`THICKNESS`] neighbouring row planes or column planes. Objects that no ray can
//! see, those whose bit in V or W is 0, are not stored at all. The others are ordered by where the image
//! shows them, 64 to a block, and blocks are numbered by their nearest depth.
//!
//! - *Upper maps*: for each row and column of tiles a bit per block: does the block touch it.
//!   Their AND gives a tile's blocks, nearest first.
//! - *Lower maps*: for each block the words ⁱR and ʲS of the slices it spans, a bit per object.
//!   `R & S` gives the candidates of the 4 × 4 pixels where two slices meet, which are
//!   then tested in lanes. What lies behind all hits so far is not looked at.

mod all;
mod build;
mod maps;
mod memory;
mod order;
mod serve;
mod single;
mod tile;

pub use memory::Bytes;

use accel::Raster;
use lanes::{Level, PackedObjects};
use maps::{Block, TileMaps};
use primitives::KernelId;

/// Pixels across a slice, so that two slices meet in as many pixels as the widest lanes hold.
pub const THICKNESS: u32 = 4;

/// How the maps of a raster are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The ray-triangle test.
    pub kernel: KernelId,
    /// The instruction set.
    pub simd: Level,
    /// Slices across a tile.
    pub tile: u32,
    /// How much longer a block is in depth than it is wide: a power of two's exponent.
    pub depth_bits: u32,
    /// Objects that span more slices than this are kept apart from smaller ones; so are those that span
    /// four and sixteen times as many.
    pub large: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { kernel: KernelId::MollerTrumbore, simd: Level::best(), tile: 8, depth_bits: 2, large: 16 }
    }
}

/// The bit maps R and S of one raster, and the objects it can see.
pub struct RasterMaps<O: PackedObjects> {
    objects: O,
    raster: Raster,
    settings: Settings,
    shown: usize,
    geometry: O::Blocks,
    blocks: Vec<Block>,
    words: Vec<u64>,
    tiles: TileMaps,
}

#[cfg(test)]
mod tests;
