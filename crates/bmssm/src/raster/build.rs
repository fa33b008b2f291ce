//! Building the maps: no dense map is ever made.

use super::maps::{Block, GROUP, GROUPS, TileMaps};
use super::order::{Shown, shown, sorted};
use super::{RasterMaps, Settings, THICKNESS};
use accel::objects::{BLOCK, EMPTY_SLOT};
use accel::{Objects, Raster, concatenated, filled};
use rayon::prelude::*;

/// Blocks handled by one task.
const CHUNK: usize = 64;

/// Headers and words of neighbouring blocks, and the objects in their slots.
#[derive(Default)]
struct Part {
    blocks: Vec<Block>,
    words: Vec<u64>,
    ids: Vec<u32>,
}

impl<O: Objects> RasterMaps<O> {
    /// Builds the maps of `raster` in the current rayon pool.
    pub fn build(objects: O, raster: &Raster, settings: Settings) -> Self {
        let shown = shown(objects, raster, settings.simd);
        let order = sorted(&shown, raster, &settings);
        let mut parts: Vec<Part> = order
            .par_chunks(CHUNK * BLOCK)
            .map(|slots| {
                let mut part = Part::default();
                for block in slots.chunks(BLOCK) {
                    part.push(block.iter().map(|&i| shown[i as u32 as usize]));
                }
                part
            })
            .collect();
        drop(order);
        let mut words = 0;
        let mut unordered = Vec::with_capacity(shown.len().div_ceil(BLOCK));
        for part in &parts {
            unordered.extend(part.blocks.iter().map(|b| Block { words: b.words + words, ..*b }));
            words += part.words.len() as u32;
        }
        let words: Vec<_> = parts.iter_mut().map(|part| std::mem::take(&mut part.words)).collect();
        let words = concatenated(&words);
        // Depths are not negative, so their bits are ordered as they are. Words stay in the order of places.
        let mut nearest_first: Vec<(u32, u32)> =
            unordered.iter().zip(0..).map(|(block, i)| (block.depth[0].to_bits(), i)).collect();
        nearest_first.sort_unstable();
        let blocks: Vec<Block> = nearest_first.iter().map(|&(_, i)| unordered[i as usize]).collect();
        let mut ids = filled(EMPTY_SLOT, blocks.len() * BLOCK);
        ids.par_chunks_exact_mut(BLOCK).zip(&nearest_first).with_min_len(CHUNK).for_each(|(ids, &(_, i))| {
            let (part, block) = (i as usize / CHUNK, i as usize % CHUNK);
            ids.copy_from_slice(&parts[part].ids[block * BLOCK..][..BLOCK]);
        });
        drop(parts);
        let count = shown.len();
        drop(shown);
        let tiles = |pixels: u32| pixels.div_ceil(THICKNESS).div_ceil(settings.tile);
        let tiles = TileMaps::new(&blocks, tiles(raster.rows), tiles(raster.cols), settings.tile);
        let geometry = objects.blocks(&ids);
        Self { objects, raster: *raster, settings, shown: count, geometry, blocks, words, tiles }
    }
}

impl Part {
    /// Appends a block.
    fn push(&mut self, objects: impl Iterator<Item = Shown>) {
        let (mut slots, mut count) = ([Shown::default(); BLOCK], 0);
        let mut keys = [u64::MAX; BLOCK];
        let (mut row, mut row_end, mut col, mut col_end) = (u32::MAX, 0, u32::MAX, 0);
        for ((slot, key), object) in slots.iter_mut().zip(&mut keys).zip(objects) {
            *slot = object;
            *key = u64::from(object.depth.to_bits()) << 32 | count as u64;
            (row, row_end) = (row.min(object.rows[0]), row_end.max(object.rows[1] + 1));
            (col, col_end) = (col.min(object.cols[0]), col_end.max(object.cols[1] + 1));
            count += 1;
        }
        // Nearest first.
        keys[..count].sort_unstable();
        let mut depth = [f32::INFINITY; GROUPS];
        for (depth, key) in depth.iter_mut().zip(keys[..count].iter().step_by(GROUP)) {
            *depth = f32::from_bits((key >> 32) as u32);
        }
        let first = self.words.len();
        let block = Block { words: first as u32, row, rows: row_end - row, col, cols: col_end - col, depth };
        self.words.resize(first + block.len(), 0);
        let (r, s) = self.words[first..].split_at_mut(block.rows as usize);
        for (slot, key) in keys[..count].iter().enumerate() {
            let object = &slots[*key as u32 as usize];
            for word in &mut r[(object.rows[0] - row) as usize..=(object.rows[1] - row) as usize] {
                *word |= 1 << slot;
            }
            for word in &mut s[(object.cols[0] - col) as usize..=(object.cols[1] - col) as usize] {
                *word |= 1 << slot;
            }
            self.ids.push(object.id);
        }
        self.ids.resize(self.ids.len() + BLOCK - count, EMPTY_SLOT);
        self.blocks.push(block);
    }
}
