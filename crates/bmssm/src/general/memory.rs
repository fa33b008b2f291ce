//! What the maps take, and what building them takes, from the number of objects alone.

use super::Storage;
use super::boxes::BlockBoxes;
use super::maps::BlockMaps;
use super::order;
use super::tree::Node;
use crate::id::UNCOUNTED;
use lanes::BLOCK;
use lanes::split::Item;

/// The most bytes at any moment of building maps over so many objects, built by so many threads, whose geometry takes `copy` bytes for a number of slots in this storage.
pub fn bytes(objects: usize, threads: usize, storage: Storage, copy: impl Fn(usize) -> u128) -> u128 {
    let (item, key) = (size_of::<Item>(), size_of::<u64>());
    let (blocks, parts) = (max_blocks(objects), max_parts(objects));
    let slots = blocks * BLOCK;
    // Boxes with their keys while these are sorted, and then with their copies along the curve.
    let sorting = objects * (item + key) + accel::keys::sort_bytes(objects, threads);
    let copying = objects * (2 * item + key);
    // Clusters as they are found and as they are joined; then joined alone, and as much again to split them.
    let clusters = order::max_clusters(objects) * item;
    let clustering = objects * (item + key) + 3 * clusters;
    let boxes = if storage == Storage::Boxes { size_of::<BlockBoxes>() } else { 0 };
    let laid = blocks * (size_of::<BlockMaps>() + boxes + item) + slots * size_of::<u32>();
    let cutting =
        objects * item + 3 * clusters + laid + parts * order::PART_BYTES + order::cut_bytes(objects, threads);
    // The tree as it grows, twice, beside the boxes twice.
    let nodes = blocks.div_ceil(NODE_BLOCKS) * size_of::<Node>();
    let growing = laid + blocks * item + 2 * nodes;
    let copy = copy(slots);
    let maps = blocks * (size_of::<BlockMaps>() + boxes) + nodes;
    let packing = (maps + slots * size_of::<u32>()) as u128 + copy;
    let peak = [sorting, copying, clustering, cutting, growing].into_iter().max().unwrap_or_default();
    packing.max(peak as u128) + UNCOUNTED
}

/// Blocks to a node, about, where there are many; nodes of few blocks have as few as two.
const NODE_BLOCKS: usize = 4;

/// Parts are halves of what was too much for one, though not the smallest halves.
fn max_parts(objects: usize) -> usize {
    // One for small objects, one for large ones.
    2 + objects / (order::PART / 4)
}

/// The last block of each part may hold less than others.
fn max_blocks(objects: usize) -> usize {
    let parts = if objects <= order::PART { 2.min(objects) } else { max_parts(objects) };
    objects / BLOCK + parts
}
