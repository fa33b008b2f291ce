//! Triangles that are tested where the scene has them: blocks that copy nothing but numbers.

use super::TriangleBlocks;
use super::frame::Limits;
use super::search::{Rays, Search, TriangleKernel};
use crate::kernel::Packed;
use accel::{Nearest, Objects};
use lanes::packet::{NearestPacket, Packet};
use lanes::{EMPTY_SLOT, ROW, Row, Simd};

/// As many rows as kernels pack, or more.
const MOST_ROWS: usize = 16;

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
        const { assert!(K::ROWS <= MOST_ROWS) };
        let mut group = [Row([0.0; ROW]); MOST_ROWS];
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
