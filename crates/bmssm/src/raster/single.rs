//! Single pixels, coverage and memory.

use super::{RasterMaps, THICKNESS};
use accel::{Footprint, Hit, Nearest, Raster, vec_bytes};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, PackedObjects, Simd, Task, ones};

/// The ray of one pixel.
struct Pixel<'a, O: PackedObjects> {
    maps: &'a RasterMaps<O>,
    row: u32,
    col: u32,
}

impl<O: PackedObjects> Task for Pixel<'_, O> {
    type Out = Nearest;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Nearest {
        let Self { maps, row, col } = self;
        let one = maps.geometry.one(&maps.raster.ray(row, col));
        let (row, col) = (row / THICKNESS, col / THICKNESS);
        let mut best = Nearest::new(f32::INFINITY);
        let across = maps.settings.tile;
        for (i, (r, c)) in maps.tiles.of(row / across, col / across).enumerate() {
            for at in ones(r & c).map(|bit| i * 64 + bit) {
                if maps.blocks[at].depth[0] > best.t {
                    maps.geometry.resolve(&one, &mut best);
                    return best;
                }
                let candidates = maps.candidates(at, row, col);
                if candidates != 0 {
                    maps.geometry.closest(s, at, candidates, &one, &mut best);
                }
            }
        }
        maps.geometry.resolve(&one, &mut best);
        best
    }
}

impl<O: PackedObjects> RasterMaps<O> {
    /// R & S: the objects of a block in a slice of rows and one of columns.
    #[inline(always)]
    pub(super) fn candidates(&self, block: usize, row: u32, col: u32) -> u64 {
        let block = &self.blocks[block];
        // Wraps to a number beyond the block's slices where the pixel lies before them.
        let (r, c) = (row.wrapping_sub(block.row), col.wrapping_sub(block.col));
        if r >= block.rows || c >= block.cols {
            return 0;
        }
        let words = &self.words[block.words as usize..];
        words[r as usize] & words[(block.rows + c) as usize]
    }

    /// The nearest hit of one pixel.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub fn closest(&self, row: u32, col: u32) -> Option<Hit> {
        assert!(row < self.raster.rows && col < self.raster.cols, "pixel ({row}, {col}) outside the image");
        self.settings.simd.run(Pixel { maps: self, row, col }).hit()
    }

    /// The raster that the maps serve.
    pub fn raster(&self) -> &Raster {
        &self.raster
    }

    /// Objects that the image can show: their bits in both V and W are 1 (Skala 1993, §2).
    pub fn shown(&self) -> usize {
        self.shown
    }

    /// A bit per object: whether the image can show it, V & W (Skala 1993, §2).
    pub fn coverage(&self) -> Vec<u64> {
        let mut bits = vec![0; self.objects.len().div_ceil(64)];
        for slot in 0..self.blocks.len() * BLOCK {
            let object = self.geometry.object(slot);
            if object != EMPTY_SLOT {
                bits[object as usize / 64] |= 1 << (object % 64);
            }
        }
        bits
    }

    /// Blocks of [`BLOCK`] objects.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// What the maps hold in memory.
    pub fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("blocks", vec_bytes(&self.blocks))
            .structure("words", vec_bytes(&self.words))
            .structure("tiles", self.tiles.bytes())
            .geometry_copy("objects", self.geometry.bytes())
    }
}
