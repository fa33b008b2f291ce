//! Building the maps: no dense map is ever made.

use super::maps::{Block, GROUP, GROUPS, TileMaps};
use super::order::{Shown, shown, sorted};
use super::{RasterMaps, Settings, THICKNESS};
use accel::objects::{BLOCK, EMPTY_SLOT};
use accel::{Objects, Raster};
use rayon::prelude::*;

/// Blocks handled by one task.
const CHUNK: usize = 64;

/// Headers and words of neighbouring blocks, and the objects in their slots.
#[derive(Default)]
struct Part {
    blocks: Vec<Block>,
    words: Vec<u64>,
}

impl<O: Objects> RasterMaps<O> {
    /// Builds the maps of `raster` in the current rayon pool.
    pub fn build(objects: O, raster: &Raster, settings: Settings) -> Self {
        let shown = shown(objects, raster);
        let mut order = sorted(&shown, raster, &settings);
        let depth_of = |i: u32| shown[i as usize].depth;
        // Nearest first within each block, then blocks by their nearest.
        order.par_chunks_mut(BLOCK).with_min_len(CHUNK).for_each(|block| {
            block.sort_unstable_by_key(|&i| (depth_of(i).to_bits(), i));
        });
        let mut nearest_first: Vec<u32> = (0..order.len().div_ceil(BLOCK) as u32).collect();
        // Depths are not negative, so their bits are ordered as they are.
        nearest_first.sort_by_key(|&b| depth_of(order[b as usize * BLOCK]).to_bits());
        let slots_of = |b: u32| &order[b as usize * BLOCK..order.len().min((b as usize + 1) * BLOCK)];

        let parts: Vec<Part> = nearest_first
            .par_chunks(CHUNK)
            .map(|blocks| {
                let mut part = Part::default();
                for &b in blocks {
                    part.push(slots_of(b).iter().map(|&i| &shown[i as usize]));
                }
                part
            })
            .collect();
        let mut ids = vec![EMPTY_SLOT; nearest_first.len() * BLOCK];
        for (ids, &b) in ids.chunks_exact_mut(BLOCK).zip(&nearest_first) {
            for (id, &i) in ids.iter_mut().zip(slots_of(b)) {
                *id = shown[i as usize].id;
            }
        }
        drop(order);
        let mut blocks = Vec::with_capacity(nearest_first.len());
        let mut words = Vec::with_capacity(parts.iter().map(|p| p.words.len()).sum());
        for part in parts {
            let first = words.len() as u32;
            words.extend_from_slice(&part.words);
            blocks.extend(part.blocks.into_iter().map(|b| Block { words: b.words + first, ..b }));
        }
        let count = shown.len();
        drop(shown);
        let tiles = |pixels: u32| pixels.div_ceil(THICKNESS).div_ceil(settings.tile);
        let tiles = TileMaps::new(&blocks, tiles(raster.rows), tiles(raster.cols), settings.tile);
        let geometry = objects.blocks(&ids);
        Self { objects, raster: *raster, settings, shown: count, geometry, blocks, words, tiles }
    }
}

impl Part {
    /// Appends a block of objects that come nearest first.
    fn push<'a>(&mut self, objects: impl Iterator<Item = &'a Shown> + Clone) {
        let range = |of: fn(&Shown) -> [u32; 2]| {
            let ends = |(low, end): (u32, u32), [a, b]: [u32; 2]| (low.min(a), end.max(b + 1));
            objects.clone().map(of).fold((u32::MAX, 0), ends)
        };
        let (row, row_end) = range(|s| s.rows);
        let (col, col_end) = range(|s| s.cols);
        let mut depth = [f32::INFINITY; GROUPS];
        for (slot, object) in objects.clone().enumerate() {
            let group = &mut depth[slot / GROUP];
            *group = group.min(object.depth);
        }
        let first = self.words.len();
        let block = Block { words: first as u32, row, rows: row_end - row, col, cols: col_end - col, depth };
        self.words.resize(first + block.len(), 0);
        let (r, s) = self.words[first..].split_at_mut(block.rows as usize);
        for (slot, object) in objects.enumerate() {
            let fill = |words: &mut [u64], [a, b]: [u32; 2], from: u32| {
                for word in &mut words[(a - from) as usize..=(b - from) as usize] {
                    *word |= 1 << slot;
                }
            };
            fill(r, object.rows, row);
            fill(s, object.cols, col);
        }
        self.blocks.push(block);
    }
}
