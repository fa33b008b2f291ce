//! The order of objects: along a Morton curve, then into blocks of 64 by splits within stretches
//! of it.

use super::maps::UnitBox;
use super::split::{Item, Shape};
use accel::objects::BLOCK;
use rayon::prelude::*;
use std::ops::Range;

/// A block: its objects in the order of items, and their box.
#[derive(Clone, Debug)]
pub struct Block {
    /// Which items.
    pub items: Range<usize>,
    /// The box of all of them.
    pub bounds: UnitBox,
}

/// Bits of a Morton key for each axis.
const BITS: u32 = 11;

/// Sorts boxes along the curve of their centres (G. M. Morton, 1966).
pub fn along_curve(boxes: &[UnitBox]) -> Vec<Item> {
    let mut keys: Vec<(u64, u32)> =
        boxes.par_iter().with_min_len(4096).zip(0..boxes.len() as u32).map(|(b, id)| (key(b), id)).collect();
    radix_sort(&mut keys);
    keys.par_iter().with_min_len(4096).map(|(_, id)| Item::new(*id, &boxes[*id as usize])).collect()
}

fn key(bounds: &UnitBox) -> u64 {
    let cell = |axis: usize| {
        let center = 0.5 * (bounds.min[axis] + bounds.max[axis]);
        spread((center * (1 << BITS) as f32).clamp(0.0, ((1 << BITS) - 1) as f32) as u64)
    };
    cell(0) | cell(1) << 1 | cell(2) << 2
}

/// Puts two zero bits between all bits.
fn spread(v: u64) -> u64 {
    let v = (v | v << 32) & 0x001f_0000_0000_ffff;
    let v = (v | v << 16) & 0x001f_0000_ff00_00ff;
    let v = (v | v << 8) & 0x100f_00f0_0f00_f00f;
    let v = (v | v << 4) & 0x10c3_0c30_c30c_30c3;
    (v | v << 2) & 0x1249_2492_4924_9249
}

/// Least digits first, all digits counted in one pass.
fn radix_sort(keys: &mut Vec<(u64, u32)>) {
    const DIGIT: u32 = 11;
    const DIGITS: usize = (3 * BITS).div_ceil(DIGIT) as usize;
    const VALUES: usize = 1 << DIGIT;
    let digit = |key: u64, of: usize| (key >> (DIGIT * of as u32)) as usize & (VALUES - 1);
    let mut counts = vec![[0u32; VALUES]; DIGITS];
    for (key, _) in &*keys {
        for (of, counts) in counts.iter_mut().enumerate() {
            counts[digit(*key, of)] += 1;
        }
    }
    let mut sorted = vec![(0, 0); keys.len()];
    for (of, counts) in counts.iter_mut().enumerate() {
        let mut first = 0;
        for count in counts.iter_mut() {
            first += std::mem::replace(count, first);
        }
        for entry in &*keys {
            let place = &mut counts[digit(entry.0, of)];
            sorted[*place as usize] = *entry;
            *place += 1;
        }
        std::mem::swap(keys, &mut sorted);
    }
}

/// From this many items on the two parts are cut by two threads.
const PARALLEL: usize = 1 << 13;

/// Reorders the items within each stretch of so many, and cuts them into blocks, full but for a stretch's last.
///
/// One stretch over all items gives the best blocks; shorter ones are cut faster, as they stay in cache.
pub fn blocks(shape: &Shape, items: &mut [Item], stretch: usize) -> Vec<Block> {
    let stretch = stretch.min(items.len()).next_multiple_of(BLOCK).max(BLOCK);
    let cut = |(number, items): (usize, &mut [Item])| cut(shape, items, number * stretch);
    items.par_chunks_mut(stretch).enumerate().flat_map_iter(cut).collect()
}

fn cut(shape: &Shape, items: &mut [Item], first: usize) -> Vec<Block> {
    let len = items.len();
    if len < PARALLEL {
        let mut blocks = Vec::with_capacity(len.div_ceil(BLOCK) + 1);
        cut_here(shape, items, first, &mut blocks);
        return blocks;
    }
    let at = shape.divide(items, BLOCK);
    let (left, right) = items.split_at_mut(at);
    let (mut left, right) = rayon::join(|| cut(shape, left, first), || cut(shape, right, first + at));
    left.extend(right);
    left
}

fn cut_here(shape: &Shape, items: &mut [Item], first: usize, blocks: &mut Vec<Block>) {
    if items.len() <= BLOCK {
        arrange(items);
        blocks.push(Block { items: first..first + items.len(), bounds: shape.bounds_of(items) });
        return;
    }
    let at = shape.divide(items, BLOCK);
    let (left, right) = items.split_at_mut(at);
    cut_here(shape, left, first, blocks);
    cut_here(shape, right, first + at, blocks);
}

/// Orders the items of a block so that neighbours in space share groups of 16.
fn arrange(items: &mut [Item]) {
    let len = items.len();
    if len <= 16 {
        return;
    }
    let half = if len > 32 { 32 } else { 16 };
    let axis = Shape::longest_axis(items);
    items.select_nth_unstable_by(half, |a, b| a.center(axis).total_cmp(&b.center(axis)));
    let (left, right) = items.split_at_mut(half);
    arrange(left);
    arrange(right);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_radix_sort_sorts() {
        let mut state = 3u64;
        let mut keys: Vec<(u64, u32)> = (0..5000)
            .map(|id| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (state >> 31, id)
            })
            .collect();
        let mut reference = keys.clone();
        reference.sort();
        radix_sort(&mut keys);
        assert_eq!(keys, reference);
    }

    #[test]
    fn keys_interleave_the_axes() {
        assert_eq!(spread(0b111), 0b1_001_001);
        let corner = UnitBox { min: [1.0; 3], max: [1.0; 3] };
        assert_eq!(key(&corner), (1 << (3 * BITS)) - 1);
    }
}
