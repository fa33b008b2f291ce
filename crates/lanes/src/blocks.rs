//! Objects packed in blocks of 64: a structure with bit maps speaks of them in masks.

use crate::Tile;
use crate::packet::{NearestPacket, Packet, Pairs};
use crate::row::{ROW, Row};
use crate::simd::Simd;
use accel::{Bounds, BuildError, Common, Nearest, Objects, Ray};

/// Objects in a block: one bit each of a 64-bit word.
pub const BLOCK: usize = 64;

/// In an order of objects: a slot that holds none.
pub const EMPTY_SLOT: u32 = u32::MAX;

/// Objects that can be reordered and packed.
pub trait PackedObjects: Objects + Copy {
    /// The objects reordered and packed by 64.
    type Blocks: Blocks;

    /// Their boxes, of the same type wherever boxes come about in the same way: what asks for nothing else is compiled
    /// once for all of these.
    type Shape: Bounds + Copy;

    /// The boxes.
    fn shape(&self) -> Self::Shape;

    /// Copies the objects into blocks for a structure: slot i holds object `order[i]`, or nothing for [`EMPTY_SLOT`].
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory.
    fn blocks(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError>;

    /// Bytes of the blocks of so many slots, about: what is held against a limit before they are made.
    fn bytes_of_blocks(slots: usize) -> u128 {
        slots as u128 * 4
    }

    /// The same without a copy of geometry where there is a way: tests read the scene's own buffers, which costs time and saves memory.
    ///
    /// # Errors
    /// As there.
    fn blocks_in_place(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError> {
        self.blocks(structure, order)
    }
}

/// A slot, what rays have in common, and what [`Blocks::prepare`] computed of it for the slot's 16.
#[derive(Clone, Copy, Debug)]
pub struct Shared<'a> {
    /// The slot.
    pub slot: usize,
    /// A point or a direction.
    pub common: &'a Common,
    /// [`Blocks::PREPARED_ROWS`] rows.
    pub rows: &'a [Row],
}

/// Objects packed in blocks of 64 slots, tested by mask.
pub trait Blocks: Send + Sync {
    /// One ray, prepared.
    type One: Copy;
    /// `LANES` rays, prepared.
    type Many<S: Simd>: Copy;

    /// Bytes on the heap: a copy of geometry.
    fn bytes(&self) -> usize;

    /// The object in a slot, or [`EMPTY_SLOT`].
    fn object(&self, slot: usize) -> u32;

    /// Asks for the memory of a block that is soon to be tested.
    #[inline(always)]
    fn prefetch(&self, block: usize) {
        let _ = block;
    }

    /// Prepares a ray.
    fn one(&self, ray: &Ray) -> Self::One;

    /// Prepares `LANES` rays.
    fn many<S: Simd>(&self, s: S, rays: &Packet<S>) -> Self::Many<S>;

    /// Tests the objects of `block` whose bits are set in `mask`. Hits may be deferred until [`Blocks::resolve`].
    fn closest<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, best: &mut Nearest);

    /// Whether any object of `block` whose bit is set in `mask` is hit at t in
    /// `[ray.t_min, t_max]`.
    fn any<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, t_max: f32) -> bool {
        let mut best = Nearest::new(t_max);
        // A hit that is deferred is a certain one.
        self.closest(s, block, mask, ray, &mut best);
        best.object != Nearest::NONE
    }

    /// Resolves what [`Blocks::closest`] deferred: before it, `best` holds an upper bound of t, after it a hit. By default
    /// nothing is deferred.
    #[inline(always)]
    fn resolve(&self, ray: &Self::One, best: &mut Nearest) {
        let _ = (ray, best);
    }

    /// Whether [`Blocks::pairs`] is the better way for rays that meet a few objects of a block each, at instruction set `S`.
    fn takes_pairs<S: Simd>() -> bool {
        false
    }

    /// Tests rays and objects in pairs; `best` has a place for each ray of the packet. Hits may be deferred until
    /// [`Blocks::resolve_each`].
    fn pairs<S: Simd>(&self, s: S, pairs: &Pairs<'_, S>, best: &mut [Nearest; ROW]) {
        self.pairs_one_by_one(s, pairs, best);
    }

    /// Resolves what [`Blocks::pairs`] deferred for each of the rays.
    #[inline(always)]
    fn resolve_each<S: Simd>(&self, s: S, rays: &[Ray], best: &mut [Nearest]) {
        let _ = (s, rays, best);
    }

    /// [`Blocks::pairs`], each by [`Blocks::closest`].
    #[inline(always)]
    fn pairs_one_by_one<S: Simd>(&self, s: S, pairs: &Pairs<'_, S>, best: &mut [Nearest; ROW]) {
        for (ray, slot) in pairs.rays.iter().zip(pairs.slots).take(pairs.len) {
            let lane = usize::from(*ray);
            let one = self.one(&pairs.packet.ray(s, lane));
            self.closest(s, pairs.block, 1 << slot, &one, &mut best[lane]);
            self.resolve(&one, &mut best[lane]);
        }
    }

    /// Tests the object of one slot with `LANES` rays. Hits may be deferred until [`Blocks::resolve_packet`].
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Self::Many<S>, best: &mut NearestPacket<S>);

    /// Rows of values for each 16 slots that [`Blocks::prepare`] computes.
    const PREPARED_ROWS: usize = 0;

    /// Computes, for the 16 slots from `first` on (a multiple of 16), whatever is the same for all rays
    /// with this in common.
    ///
    /// # Panics
    /// If `rows` are fewer than [`Blocks::PREPARED_ROWS`].
    #[inline(always)]
    fn prepare<S: Simd>(&self, s: S, first: usize, common: &Common, rows: &mut [Row]) {
        let _ = (s, first, common, rows);
    }

    /// [`Blocks::packet`] for rays with this in common, with the rows prepared for the slot's 16:
    /// the same operations, so the same bits, but those that don't depend on the ray done before.
    #[inline(always)]
    fn packet_prepared<S: Simd>(&self, s: S, at: Shared, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        self.packet(s, at.slot, rays, best);
    }

    /// Rows of values for each 16 slots that [`Blocks::prepare_culling`] computes; none where nothing is ever culled.
    const CULLING_ROWS: usize = 0;

    /// Computes, for the 16 slots from `first` on (a multiple of 16), what [`Blocks::survivors`] looks at in the cells of a
    /// tile, and says which of them rays of the tile may hit, as bits.
    ///
    /// # Panics
    /// If `rows` are fewer than [`Blocks::CULLING_ROWS`].
    #[inline(always)]
    fn prepare_culling<S: Simd>(&self, s: S, first: usize, tile: &Tile, rows: &mut [Row]) -> u32 {
        let _ = (s, first, tile, rows);
        u32::MAX
    }

    /// Of 16 slots those that rays of a cell may hit, as bits: no test of another with any of these rays gives a hit. The cell's
    /// middle is told from that of the tile.
    ///
    /// # Panics
    /// If `rows` are fewer than [`Blocks::CULLING_ROWS`].
    #[inline(always)]
    fn survivors<S: Simd>(s: S, rows: &[Row], middle: [f32; 2]) -> u32 {
        let _ = (s, rows, middle);
        u32::MAX
    }

    /// [`Blocks::resolve`] for what [`Blocks::packet`] deferred.
    #[inline(always)]
    fn resolve_packet<S: Simd>(&self, s: S, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        let _ = (s, rays, best);
    }
}
