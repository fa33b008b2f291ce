//! The order of objects: along a Morton curve, split into parts by clusters of neighbours, and the parts
//! into blocks of 64 object by object.

use super::boxes::BlockBoxes;
use super::maps::BlockMaps;
use super::scene::is_large;
use super::sides::Sides;
use super::{Settings, Storage};
use crate::id::ID;
use accel::parallel::extend;
use accel::parallel::prelude::*;
use accel::{BuildError, Cancel, concatenated, filled};
use lanes::split::{Divide, Extremes, Item, Left, Scratch, Shape};
use lanes::{BLOCK, EMPTY_SLOT, Level, Simd, Task};

/// The objects in order, block by block.
pub struct Order {
    /// The object of each slot.
    pub slots: Vec<u32>,
    /// The maps of each block.
    pub maps: Vec<BlockMaps>,
    /// The boxes of each block's objects, if they are wanted.
    pub boxes: Vec<BlockBoxes>,
    /// The box of each block.
    pub blocks: Vec<Item>,
}

impl Order {
    /// Orders objects with these boxes and keys.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory, and [`BuildError::Cancelled`].
    pub fn new(
        shape: &Shape,
        boxes: Vec<Item>,
        keys: Vec<u64>,
        settings: Settings,
        cancel: Cancel,
    ) -> Result<Self, BuildError> {
        let keys = accel::keys::sort(ID, keys)?;
        cancel.check(ID)?;
        // Copied at once, as nothing but the copies then has to wait for memory.
        let along = |key: &u64| boxes[*key as u32 as usize];
        let mut items = accel::reserved(ID, keys.len())?;
        extend(&mut items, keys.par_iter().with_min_len(CHUNK).map(along));
        drop(boxes);
        cancel.check(ID)?;
        let small = keys.partition_point(|key| !is_large(*key));
        let mut small_clusters = clusters(&items, &keys[..small], 0)?;
        let mut large_clusters = clusters(&items, &keys[small..], small)?;
        drop(keys);
        cancel.check(ID)?;
        let most = small_clusters.len().max(large_clusters.len());
        let (mut room, mut marks) = (filled(ID, Item::EMPTY, most)?, accel::zeroed(ID, most)?);
        let mut halve =
            |clusters| split(shape, clusters, Scratch { items: &mut room, marks: &mut marks }, settings.simd);
        let mut parts = halve(&mut small_clusters);
        parts.extend(halve(&mut large_clusters));
        drop((room, marks));
        cancel.check(ID)?;
        let blocks = |part: &Part| part.objects.div_ceil(BLOCK);
        let all = parts.iter().map(blocks).sum();
        let boxed = settings.storage == Storage::Boxes;
        let mut order = Self {
            slots: filled(ID, EMPTY_SLOT, all * BLOCK)?,
            maps: filled(ID, BlockMaps::EMPTY, all)?,
            boxes: filled(ID, BlockBoxes::EMPTY, if boxed { all } else { 0 })?,
            blocks: filled(ID, Item::EMPTY, all)?,
        };
        let mut rooms = accel::reserved(ID, parts.len())?;
        let (mut slots, mut maps) = (&mut order.slots[..], &mut order.maps[..]);
        let (mut boxes, mut bounds) = (&mut order.boxes[..], &mut order.blocks[..]);
        let mut first = 0;
        for part in parts {
            let n = blocks(&part);
            let room = Room {
                first,
                slots: slots.split_off_mut(..n * BLOCK).expect("room for all"),
                maps: maps.split_off_mut(..n).expect("room for all"),
                boxes: boxes.split_off_mut(..if boxed { n } else { 0 }).expect("room for all"),
                blocks: bounds.split_off_mut(..n).expect("room for all"),
            };
            first += n as u32;
            rooms.push((part, room));
        }
        let cut = rooms.into_par_iter().map_init(Buffers::default, |buffers, (part, room)| {
            cancel.check(ID)?;
            settings.simd.run(Cut {
                shape,
                items: &items,
                part,
                room,
                buffers,
                exact_split: settings.exact_split,
            })
        });
        cut.collect::<Result<(), BuildError>>()?;
        Ok(order)
    }
}

/// Objects handled by one task.
const CHUNK: usize = 1 << 13;

/// Objects that a cluster has on average, at most.
const CLUSTER: usize = 8;
/// Objects that a cluster has at most.
const MAX: usize = 16;

/// Clusters of so many objects at most: what is over of each run that is cut counts as well.
pub fn max_clusters(objects: usize) -> usize {
    objects.div_ceil(CLUSTER) + objects.div_ceil(MAX) + 2
}

/// Runs of neighbours along the curve that share a cell: the place of the first among `items`, and how many there
/// are. The first key is that of the item at `place`.
///
/// # Errors
/// [`BuildError::TooLarge`] if the system doesn't give the memory.
fn clusters(items: &[Item], keys: &[u64], place: usize) -> Result<Vec<Item>, BuildError> {
    let bit = cell_bit(keys);
    let cell = |key: u64| key >> 32 >> bit;
    // Tasks begin where a cell does, so that there are the same clusters whatever the number of threads.
    let mut begins = vec![0];
    for wanted in (CHUNK..keys.len()).step_by(CHUNK) {
        let last = *begins.last().expect("the first begin");
        let from = wanted.max(last + 1);
        let step = keys[from - 1..].windows(2).position(|pair| cell(pair[0]) != cell(pair[1]));
        let Some(step) = step else { break };
        begins.push(from + step);
    }
    let of = |task: usize| {
        let end = begins.get(task + 1).copied().unwrap_or(keys.len());
        let mut clusters = accel::reserved(ID, (end - begins[task]) / CLUSTER)?;
        let mut first = begins[task];
        while first < end {
            let here = cell(keys[first]);
            let mut range = Extremes::NONE;
            let mut next = first;
            while next < end && next < first + MAX && cell(keys[next]) == here {
                range.gather(&items[place + next].extremes());
                next += 1;
            }
            let cluster = Item::new((place + first) as u32, (next - first) as u32, &range.bounds());
            accel::append(ID, &mut clusters, cluster)?;
            first = next;
        }
        Ok(clusters)
    };
    let tasks: Result<Vec<Vec<Item>>, BuildError> = (0..begins.len()).into_par_iter().map(of).collect();
    concatenated(ID, &tasks?)
}

/// The lowest bit of codes that tells cells apart if clusters are to hold [`CLUSTER`] objects on average.
fn cell_bit(keys: &[u64]) -> usize {
    // How many cells of each size begin, by the highest bit in which neighbours differ.
    let differ = |task: usize| {
        let end = keys.len().min((task + 1) * CHUNK + 1);
        let mut differ = [0usize; 33];
        for pair in keys[task * CHUNK..end].windows(2) {
            differ[32 - ((pair[0] ^ pair[1]) >> 32 << 32).leading_zeros().min(32) as usize] += 1;
        }
        differ
    };
    let add = |mut a: [usize; 33], b: [usize; 33]| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        a
    };
    let differ = (0..keys.len().div_ceil(CHUNK)).into_par_iter().map(differ).reduce(|| [0; 33], add);
    let (mut runs, mut bit) = (1, 32);
    while bit > 0 && runs + differ[bit] <= keys.len() / CLUSTER {
        runs += differ[bit];
        bit -= 1;
    }
    bit
}

/// Objects that are put into blocks by one task.
struct Part<'c> {
    clusters: &'c mut [Item],
    objects: usize,
}

/// Objects in a part, at most. All its blocks are full but the last.
pub const PART: usize = 64 * BLOCK;

/// From this many clusters on the two parts are split by two threads.
const PARALLEL: usize = 1 << 12;

fn split<'c>(shape: &Shape, clusters: &'c mut [Item], mut scratch: Scratch, simd: Level) -> Vec<Part<'c>> {
    let objects = clusters.iter().map(|cluster| cluster.weight() as usize).sum();
    if objects <= PART || clusters.len() == 1 {
        if objects == 0 {
            return Vec::new();
        }
        return vec![Part { clusters, objects }];
    }
    let left = Left::Packed(BLOCK);
    let at = simd.run(Divide { shape, items: &mut *clusters, scratch: &mut scratch, left });
    let parallel = clusters.len() >= PARALLEL;
    let (left, right) = clusters.split_at_mut(at);
    let (left, right) = ((left, scratch.take(at)), (right, scratch));
    let halve = |(clusters, scratch)| split(shape, clusters, scratch, simd);
    let (mut parts, rest) = if parallel {
        accel::parallel::join(|| halve(left), || halve(right))
    } else {
        (halve(left), halve(right))
    };
    parts.extend(rest);
    parts
}

/// Where a part's blocks go.
struct Room<'o> {
    /// The first block's number.
    first: u32,
    slots: &'o mut [u32],
    maps: &'o mut [BlockMaps],
    boxes: &'o mut [BlockBoxes],
    blocks: &'o mut [Item],
}

/// Bytes that a part takes while it waits.
pub const PART_BYTES: usize = 2 * size_of::<Part>() + size_of::<(Part, Room)>();

/// Bytes that so many threads take to cut parts of so many objects together.
pub fn cut_bytes(objects: usize, threads: usize) -> usize {
    let objects = objects.min(threads * PART);
    objects * (2 * size_of::<Item>() + 1)
        + threads * (PART / BLOCK + 2) * (size_of::<usize>() + size_of::<(usize, usize, bool)>())
}

/// What a thread keeps from part to part.
#[derive(Default)]
struct Buffers {
    items: Vec<Item>,
    scratch: Vec<Item>,
    marks: Vec<u8>,
    /// First, end, and whether the items are in `scratch`.
    open: Vec<(usize, usize, bool)>,
}

/// Splits one part into blocks.
struct Cut<'a, 'o> {
    shape: &'a Shape,
    /// All objects along the curve.
    items: &'a [Item],
    part: Part<'a>,
    room: Room<'o>,
    buffers: &'a mut Buffers,
    exact_split: usize,
}

impl Task for Cut<'_, '_> {
    type Out = Result<(), BuildError>;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Self::Out {
        let Self { shape, items: all, part, room, buffers, exact_split } = self;
        let Buffers { items, scratch, marks, open } = buffers;
        let Part { clusters, objects } = part;
        items.clear();
        if scratch.len() < objects {
            // Given back first, and no more than a part has: together threads take no more than all parts have.
            (*items, *scratch, *marks) = Default::default();
            *items = accel::reserved(ID, objects)?;
            *scratch = filled(ID, Item::EMPTY, objects)?;
            *marks = accel::zeroed(ID, objects)?;
        }
        open.clear();
        // By clusters, as far as wanted. What is left over of a block belongs to the next stretch.
        let mut stretches = Vec::with_capacity(PART / BLOCK + 2);
        stretches.push(0);
        open.push((0, clusters.len(), false));
        while let Some((first, end, _)) = open.pop() {
            let clusters = &mut clusters[first..end];
            let weight: usize = clusters.iter().map(|cluster| cluster.weight() as usize).sum();
            if weight <= exact_split || clusters.len() == 1 {
                for cluster in &*clusters {
                    let first = cluster.number() as usize;
                    items.extend_from_slice(&all[first..first + cluster.weight() as usize]);
                }
                let so_far = items.len() / BLOCK * BLOCK;
                if stretches.last().is_some_and(|last| *last < so_far) {
                    stretches.push(so_far);
                }
            } else {
                let scratch = &mut Scratch { items: &mut *scratch, marks: &mut *marks };
                let middle = Divide { shape, items: clusters, scratch, left: Left::Packed(BLOCK) }.run(s);
                open.push((first + middle, end, false));
                open.push((first, first + middle, false));
            }
        }
        if stretches.last().is_some_and(|last| *last < objects) {
            stretches.push(objects);
        }
        open.extend(stretches.windows(2).rev().map(|pair| (pair[0], pair[1], false)));
        let mut at = 0;
        // Each division copies from one of two places to the other.
        while let Some((first, end, swapped)) = open.pop() {
            let (from, to) =
                if swapped { (&mut *scratch, &mut *items) } else { (&mut *items, &mut *scratch) };
            let from = &from[first..end];
            if from.len() <= BLOCK {
                let bounds = Extremes::of(from).bounds();
                let sides = Sides::of(from);
                room.maps[at] = BlockMaps::new(s, &bounds, &sides);
                if let Some(boxes) = room.boxes.get_mut(at) {
                    *boxes = BlockBoxes::new(s, &room.maps[at], &sides);
                }
                room.blocks[at] = Item::new(room.first + at as u32, 1, &bounds);
                for (slot, item) in room.slots[at * BLOCK..].iter_mut().zip(from) {
                    *slot = item.number();
                }
                at += 1;
            } else {
                let to = &mut Scratch { items: &mut to[first..end], marks: &mut *marks };
                let middle = first + shape.divide(s, from, to, Left::Whole(BLOCK));
                open.push((middle, end, !swapped));
                open.push((first, middle, !swapped));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::morton;
    use lanes::split::UnitBox;

    fn point(number: u32, at: [f32; 3]) -> Item {
        Item::new(number, 1, &UnitBox { min: at, max: at })
    }

    #[test]
    fn clusters_are_runs_of_all_objects() {
        let boxes: Vec<Item> = (0..5000u32).map(|i| point(i, [i as f32 / 5000.0, 0.0, 0.0])).collect();
        let keys: Vec<u64> = (0..5000).map(|i| morton::keyed(i / 5 * 8, i)).collect();
        let clusters = clusters(&boxes, &keys, 0).unwrap();
        let mut next = 0;
        for cluster in &clusters {
            assert_eq!(cluster.number(), next);
            assert!((1..=MAX as u32).contains(&cluster.weight()));
            next += cluster.weight();
        }
        assert_eq!(next, 5000);
        assert!(clusters.len() < 5000 / 4, "{}", clusters.len());
    }

    #[test]
    fn coinciding_objects_are_ordered_too() {
        let boxes: Vec<Item> = (0..9000).map(|i| point(i, [0.5; 3])).collect();
        let keys = (0..9000).map(|i| morton::keyed(7, i)).collect();
        let settings =
            Settings { simd: Level::Portable, exact_split: 128, storage: super::super::Storage::Rows };
        let order = Order::new(&Shape { extent: [1.0; 3] }, boxes, keys, settings, Cancel::NEVER).unwrap();
        assert_eq!(order.blocks.len(), order.maps.len());
        let mut slots: Vec<u32> = order.slots.into_iter().filter(|slot| *slot != EMPTY_SLOT).collect();
        slots.sort_unstable();
        assert!(slots.into_iter().eq(0..9000));
    }
}
