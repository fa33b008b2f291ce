//! How the nearest of many hits is found.

use super::frame::{LIMIT_ROWS, Limits};
use super::{CORNER_ROWS, Scratch, TriangleBlocks, TrianglePacket, TriangleRay};
use crate::Kernel;
use crate::kernel::{Many, Packed, Preparation, Prepared};
use accel::{Nearest, Objects, Ray};
use lanes::packet::{Lanes, NearestPacket, Packet, Pairs};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, ROW, Row, Simd, next_bit};

/// Kernels that triangles in blocks are tested by: those whose [`Kernel::Search`] is one.
pub trait TriangleKernel: Kernel<Search: Search<Self>> {}

impl<K: Kernel<Search: Search<K>>> TriangleKernel for K {}

/// A ray prepared for kernel `K`.
pub type OneRay<K> = TriangleRay<<K as Kernel>::One>;

/// A packet of rays prepared for kernel `K`.
pub type Rays<K, S> = TrianglePacket<S, Many<K, S>>;

/// Triangles of one block.
#[derive(Debug)]
pub struct Candidates<'a, K: Kernel> {
    /// All blocks.
    pub blocks: &'a TriangleBlocks<'a, K>,
    /// Which one.
    pub block: usize,
    /// A bit for each of them.
    pub mask: u64,
}

/// Candidates to be tested at once.
pub(super) struct Next {
    /// Their first slot.
    pub slot: usize,
    /// Bits of those that are wanted.
    pub wanted: u32,
}

impl<K: Kernel> Candidates<'_, K> {
    /// Takes the next ones off.
    #[inline(always)]
    pub(super) fn next<S: Simd>(&mut self) -> Option<Next> {
        if self.mask == 0 {
            return None;
        }
        let lanes_mask = u64::MAX >> (64 - S::LANES);
        let first = self.mask.trailing_zeros() as usize / S::LANES * S::LANES;
        let wanted = (self.mask >> first & lanes_mask) as u32;
        self.mask &= !(lanes_mask << first);
        Some(Next { slot: self.block * BLOCK + first, wanted })
    }
}

/// Tests packed triangles by kernel `K`, by default each at once. What the functions do is said at those of [`Blocks`] of
/// the same name.
pub trait Search<K: Kernel>: 'static {
    /// Rows that [`Search::limits`] writes for 16 slots.
    const LIMIT_ROWS: usize = LIMIT_ROWS;

    /// Whether several rays are better tested in pairs.
    const IN_PAIRS: bool = false;

    /// [`Blocks::closest`]
    #[inline(always)]
    fn closest<S: Simd>(s: S, set: Candidates<K>, ray: &OneRay<K>, best: &mut Nearest) {
        let blocks = set.blocks;
        blocks.visit(s, set, ray, best.t, |object, surface| {
            blocks.offer_one(ray, object, surface, best);
            Some(best.t)
        });
    }

    /// [`Blocks::any`]
    #[inline(always)]
    fn any<S: Simd>(s: S, set: Candidates<K>, ray: &OneRay<K>, t_max: f32) -> bool {
        let blocks = set.blocks;
        let mut any = false;
        blocks.visit(s, set, ray, t_max, |_, _| {
            any = true;
            None
        });
        any
    }

    /// [`Blocks::resolve`]
    #[inline(always)]
    fn resolve(blocks: &TriangleBlocks<K>, ray: &OneRay<K>, best: &mut Nearest) {
        let _ = (blocks, ray, best);
    }

    /// [`Blocks::pairs`]
    #[inline(always)]
    fn pairs<'s, S: Simd>(blocks: &TriangleBlocks<'s, K>, s: S, pairs: &Pairs<S>, best: &mut [Nearest; ROW])
    where
        TriangleBlocks<'s, K>: Blocks,
    {
        blocks.pairs_one_by_one(s, pairs, best);
    }

    /// Offers hits on `object` that are decided; of those at the same t as another's the lower number comes first by default.
    #[inline(always)]
    fn offer<S: Simd>(
        blocks: &TriangleBlocks<K>,
        s: S,
        object: u32,
        lanes: Lanes<S>,
        rays: &Packet<S>,
        best: &mut NearestPacket<S>,
    ) {
        let _ = (blocks, rays);
        best.offer(s, object, &lanes);
    }

    /// [`Blocks::resolve_each`]
    #[inline(always)]
    fn resolve_each<S: Simd>(blocks: &TriangleBlocks<K>, s: S, rays: &[Ray], best: &mut [Nearest]) {
        let _ = (blocks, s, rays, best);
    }

    /// [`Blocks::closest`], or [`Blocks::any`], where nothing is packed but numbers.
    #[inline(always)]
    fn in_place<S: Simd>(s: S, set: Candidates<K>, ray: &Ray, any: bool, best: &mut Nearest) {
        let blocks = set.blocks;
        let _ = s;
        let mut mask = set.mask;
        while !(any && best.object != Nearest::NONE)
            && let Some(place) = next_bit(&mut mask)
        {
            let object = blocks.ids.get(set.block * BLOCK + place);
            if object != EMPTY_SLOT {
                blocks.triangles.closest(object, ray, best);
            }
        }
    }

    /// [`Blocks::packet`]
    #[inline(always)]
    fn packet<S: Simd>(s: S, one: Slot<K>, rays: &Rays<K, S>, best: &mut NearestPacket<S>) {
        let Slot { blocks, slot } = one;
        let mut scratch = Scratch::EMPTY;
        let packed = blocks.unpacked(s, slot, &mut scratch.0);
        let lanes = K::rays(s, &rays.prepared, packed, best.t);
        if s.bits(lanes.hit) != 0 {
            let limits = Limits::of(&blocks.triangles.frame, &blocks.corners(packed, slot));
            blocks.offer(s, slot, rays, &limits, lanes, best);
        }
    }

    /// Writes within what hits on the triangles in `LANES` slots are plainly valid.
    #[inline(always)]
    fn limits<S: Simd>(blocks: &TriangleBlocks<K>, s: S, slot: usize, packed: Packed<'_>, rows: &mut [Row]) {
        let held = K::ROWS >= CORNER_ROWS && blocks.rows_hold_corners() && K::corners(packed).is_some();
        let corners = if held { packed.load_corners(s) } else { blocks.gather(s, slot) };
        Limits::store(s, &blocks.triangles.frame, corners, rows, slot % ROW);
    }

    /// [`Blocks::packet_prepared`]
    #[inline(always)]
    fn packet_prepared<S: Simd>(s: S, one: PreparedSlot<K>, rays: &Rays<K, S>, best: &mut NearestPacket<S>) {
        let PreparedSlot { at: Slot { blocks, slot }, prepared, limits } = one;
        let lanes = K::Preparation::rays_prepared(s, &rays.prepared, prepared, best.t);
        if s.bits(lanes.hit) != 0 {
            blocks.offer(s, slot, rays, &Limits::load(limits, slot % ROW), lanes, best);
        }
    }

    /// [`Blocks::resolve_packet`]
    #[inline(always)]
    fn resolve_packet<S: Simd>(of: &TriangleBlocks<K>, s: S, rays: &Rays<K, S>, best: &mut NearestPacket<S>) {
        let _ = (of, s, rays, best);
    }
}

/// A packed triangle.
#[derive(Debug)]
pub struct Slot<'a, K: Kernel> {
    /// All blocks.
    pub blocks: &'a TriangleBlocks<'a, K>,
    /// Its place in them.
    pub slot: usize,
}

/// A triangle with all that was computed beforehand.
#[derive(Debug)]
pub struct PreparedSlot<'a, K: Kernel> {
    /// The triangle.
    pub at: Slot<'a, K>,
    /// What the kernel prepared.
    pub prepared: Prepared<'a>,
    /// What [`Search::limits`] wrote.
    pub limits: &'a [Row],
}
