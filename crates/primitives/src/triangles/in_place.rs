//! Triangles that are tested where the scene has them: blocks that copy nothing but numbers.

use super::TriangleBlocks;
use super::frame::Limits;
use super::search::{Candidates, Rays, Search, TriangleKernel};
use crate::kernel::Packed;
use accel::{Nearest, Objects, Ray};
use lanes::packet::{NearestPacket, Packet};
use lanes::{EMPTY_SLOT, ROW, Row, Simd, Task};

/// As many rows as kernels pack, or more.
const MAX_ROWS: usize = 16;

/// [`Search::in_place`], apart from what is done with packed triangles. It takes copies of the ray and its nearest hit, as
/// the originals can then stay in registers.
pub(super) struct InPlace<'a, K: TriangleKernel> {
    set: Candidates<'a, K>,
    ray: Ray,
    any: bool,
    best: Nearest,
}

impl<'a, K: TriangleKernel> InPlace<'a, K> {
    /// The nearest hit so far of a ray after it was tested with candidates.
    #[inline(always)]
    pub fn test<S: Simd>(s: S, set: Candidates<'a, K>, ray: Ray, any: bool, best: Nearest) -> Nearest {
        s.apart(Self { set, ray, any, best })
    }
}

impl<K: TriangleKernel> Task for InPlace<'_, K> {
    type Out = Nearest;

    #[inline(always)]
    fn run<S: Simd>(mut self, s: S) -> Nearest {
        K::Search::in_place(s, self.set, &self.ray, self.any, &mut self.best);
        self.best
    }
}

impl<K: TriangleKernel> TriangleBlocks<'_, K> {
    /// [`lanes::Blocks::packet`].
    #[inline(always)]
    pub(super) fn packet_in_place<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &Rays<K, S>,
        best: &mut NearestPacket<S>,
    ) {
        let object = self.ids.get(slot);
        if object == EMPTY_SLOT {
            return;
        }
        if !K::Search::IN_PAIRS {
            return self.packet_one_by_one(s, object, &rays.rays, best);
        }
        let frame = &self.triangles.frame;
        let corners = self.triangles.corners(object);
        const { assert!(K::ROWS <= MAX_ROWS) };
        let mut group = [Row([0.0; ROW]); MAX_ROWS];
        K::pack(&frame.corners(&corners), &mut group[..K::ROWS], 0);
        let lanes = K::rays(s, &rays.prepared, Packed::new(&group[..K::ROWS], 0), best.t);
        if s.bits(lanes.hit) != 0 {
            let lanes = self.held(s, slot, rays, &Limits::of(frame, &corners), lanes);
            K::Search::offer(self, s, object, lanes, &rays.rays, best);
        }
    }

    #[inline(always)]
    fn packet_one_by_one<S: Simd>(&self, s: S, object: u32, rays: &Packet<S>, best: &mut NearestPacket<S>) {
        let mut each = [Nearest::new(0.0); ROW];
        best.store(s, &mut each);
        for (lane, nearest) in each.iter_mut().enumerate().take(S::LANES) {
            if nearest.t != f32::NEG_INFINITY {
                self.triangles.closest(object, &rays.ray(s, lane), nearest);
            }
        }
        *best = NearestPacket::load(s, &each);
    }
}
