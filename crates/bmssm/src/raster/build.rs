//! Building the maps: no dense map is ever made.

use super::maps::{Block, GROUP, GROUPS, TileMaps};
use super::memory::{Bytes, Image};
use super::order::{Shown, joined, shown, sorted};
use super::{RasterMaps, Settings, THICKNESS};
use crate::id::ID;
use accel::parallel::prelude::*;
use accel::{BuildError, Cancel, Raster, concatenated, filled};
use lanes::{BLOCK, EMPTY_SLOT, PackedObjects, Simd, Task, prefetch, ranks};

/// Blocks handled by one task.
const CHUNK: usize = 64;

/// Headers and words of neighbouring blocks, and the objects in their slots.
#[derive(Default)]
struct Part {
    blocks: Vec<Block>,
    words: Vec<u64>,
    ids: Vec<u32>,
}

impl<O: PackedObjects> RasterMaps<O> {
    /// Builds the maps of `raster` in the current rayon pool, within what is allowed.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] as soon as it is known that more would be taken than is allowed or the system gives, and
    /// [`BuildError::Cancelled`].
    pub fn build(
        objects: O,
        raster: &Raster,
        settings: Settings,
        allowed: Bytes,
        cancel: Cancel,
    ) -> Result<Self, BuildError> {
        let image = |shown, copy| Image { raster, settings: &settings, objects: objects.len(), shown, copy };
        image(0, 0).bytes(0).check(allowed)?;
        let shown = shown(objects.shape(), raster, settings.simd, cancel)?;
        let count = shown.iter().map(Vec::len).sum();
        let image = image(count, O::bytes_of_blocks(count.next_multiple_of(BLOCK)));
        let Laid { blocks, words, ids } = laid(shown, image, allowed, cancel)?;
        let tiles = |pixels: u32| pixels.div_ceil(THICKNESS).div_ceil(settings.tile);
        let tiles = TileMaps::new(&blocks, tiles(raster.rows), tiles(raster.cols), settings.tile)?;
        cancel.check(ID)?;
        let geometry = objects.blocks(ID, &ids)?;
        cancel.check(ID)?;
        Ok(Self { objects, raster: *raster, settings, shown: count, geometry, blocks, words, tiles })
    }
}

/// All blocks, their words and the objects in their slots.
struct Laid {
    blocks: Vec<Block>,
    words: Vec<u64>,
    ids: Vec<u32>,
}

/// Puts the objects in blocks, the nearest block first.
fn laid(shown: Vec<Vec<Shown>>, image: Image, allowed: Bytes, cancel: Cancel) -> Result<Laid, BuildError> {
    let Image { raster, settings, .. } = image;
    image.bytes(0).check(allowed)?;
    let shown = joined(shown)?;
    let order = sorted(&shown, raster, settings)?;
    cancel.check(ID)?;
    // Counted only where it may matter.
    if image.bytes(image.max_words()).check(allowed).is_err() {
        image.bytes(words(&shown, &order)).check(allowed)?;
    }
    let registered = order.par_chunks(CHUNK * BLOCK).map(|slots| {
        cancel.check(ID)?;
        settings.simd.run(Registered { shown: &shown, slots })
    });
    let mut parts = registered.collect::<Result<Vec<Part>, BuildError>>()?;
    drop((order, shown));
    let mut words = 0;
    let mut unordered = accel::reserved(ID, image.shown.div_ceil(BLOCK))?;
    for part in &parts {
        unordered.extend(part.blocks.iter().map(|b| Block { words: b.words + words, ..*b }));
        words += part.words.len() as u32;
    }
    let apart: Vec<_> = parts.iter_mut().map(|part| std::mem::take(&mut part.words)).collect();
    let words = concatenated(ID, &apart)?;
    drop(apart);
    // Depths are not negative, so their bits are ordered as they are. Words stay in the order of places.
    let mut nearest_first: Vec<(u32, u32)> = accel::reserved(ID, unordered.len())?;
    nearest_first.extend(unordered.iter().zip(0..).map(|(block, i)| (block.depth[0].to_bits(), i)));
    nearest_first.sort_unstable();
    let mut blocks: Vec<Block> = accel::reserved(ID, unordered.len())?;
    blocks.extend(nearest_first.iter().map(|&(_, i)| unordered[i as usize]));
    cancel.check(ID)?;
    let mut ids = filled(ID, EMPTY_SLOT, blocks.len() * BLOCK)?;
    ids.par_chunks_exact_mut(BLOCK).zip(&nearest_first).with_min_len(CHUNK).for_each(|(ids, &(_, i))| {
        let (part, block) = (i as usize / CHUNK, i as usize % CHUNK);
        ids.copy_from_slice(&parts[part].ids[block * BLOCK..][..BLOCK]);
    });
    Ok(Laid { blocks, words, ids })
}

/// How many words the blocks of this order have.
fn words(shown: &[Shown], order: &[u64]) -> usize {
    let spans = |of: fn(&Shown) -> [u32; 2], block: &[u64]| {
        let ends = block.iter().map(|slot| of(&shown[*slot as u32 as usize]));
        let [first, last] = ends.fold([u32::MAX, 0], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        (last + 1 - first) as usize
    };
    order.chunks(BLOCK).map(|block| spans(|s| s.rows, block) + spans(|s| s.cols, block)).sum()
}

/// Registers neighbouring objects, block by block.
struct Registered<'a> {
    shown: &'a [Shown],
    /// Places among `shown`, in the lower halves.
    slots: &'a [u64],
}

impl Task for Registered<'_> {
    type Out = Result<Part, BuildError>;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> Self::Out {
        let ids = accel::reserved(ID, self.slots.len().next_multiple_of(BLOCK))?;
        let mut part = Part { ids, ..Part::default() };
        for (i, block) in self.slots.chunks(BLOCK).enumerate() {
            // They lie anywhere in memory.
            for slot in self.slots.iter().skip((i + 1) * BLOCK).take(BLOCK) {
                self.shown.get(*slot as u32 as usize).map(prefetch);
            }
            part.push(block.iter().map(|&i| self.shown[i as u32 as usize]))?;
        }
        part.words.shrink_to_fit();
        Ok(part)
    }
}

impl Part {
    /// Appends a block.
    #[inline(always)]
    fn push(&mut self, objects: impl Iterator<Item = Shown>) -> Result<(), BuildError> {
        let (mut slots, mut count, mut cells) = ([Shown::default(); BLOCK], 0, 0u32);
        // Depths are not negative, so their bits are ordered as they are; slots without an object come last.
        let mut depths = [i32::MAX - 1; BLOCK];
        let (mut row, mut row_end, mut col, mut col_end) = (u32::MAX, 0, u32::MAX, 0);
        for ((slot, depth), object) in slots.iter_mut().zip(&mut depths).zip(objects) {
            *slot = object;
            *depth = object.depth.to_bits().cast_signed();
            (row, row_end) = (row.min(object.rows[0]), row_end.max(object.rows[1] + 1));
            (col, col_end) = (col.min(object.cols[0]), col_end.max(object.cols[1] + 1));
            let across = |[first, last]: [u32; 2]| last + 1 - first;
            cells = cells.saturating_add(across(object.rows).saturating_mul(across(object.cols)));
            count += 1;
        }
        let ranks = ranks(&depths);
        let mut depth = [f32::INFINITY; GROUPS];
        let mut nearest_first = [Shown::default(); BLOCK];
        for (object, rank) in slots[..count].iter().zip(ranks) {
            nearest_first[rank as usize % BLOCK] = *object;
        }
        for (depth, object) in depth.iter_mut().zip(nearest_first[..count].iter().step_by(GROUP)) {
            *depth = object.depth;
        }
        let first = self.words.len();
        let block =
            Block { words: first as u32, row, rows: row_end - row, col, cols: col_end - col, depth, cells };
        accel::make_room(ID, &mut self.words, block.len())?;
        self.words.resize(first + block.len(), 0);
        let (r, s) = self.words[first..].split_at_mut(block.rows as usize);
        for (slot, object) in nearest_first[..count].iter().enumerate() {
            for word in &mut r[(object.rows[0] - row) as usize..=(object.rows[1] - row) as usize] {
                *word |= 1 << slot;
            }
            for word in &mut s[(object.cols[0] - col) as usize..=(object.cols[1] - col) as usize] {
                *word |= 1 << slot;
            }
            self.ids.push(object.id);
        }
        self.ids.resize(self.ids.len() + BLOCK - count, EMPTY_SLOT);
        accel::append(ID, &mut self.blocks, block)
    }
}
