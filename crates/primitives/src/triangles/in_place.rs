//! Triangles that are tested where the scene has them: blocks that copy nothing but numbers.

use super::TriangleBlocks;
use crate::Kernel;
use accel::{Nearest, Objects};
use lanes::packet::{NearestPacket, Packet};
use lanes::{EMPTY_SLOT, ROW, Simd};

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// [`lanes::Blocks::packet`].
    #[inline(always)]
    pub(super) fn packet_in_place<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &Packet<S>,
        best: &mut NearestPacket<S>,
    ) {
        let object = self.ids.get(slot);
        if object == EMPTY_SLOT {
            return;
        }
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
