//! Tests that are decided at once.

use super::frame::Limits;
use super::search::{Candidates, Next, OneRay, Rays, Search};
use super::{Scratch, TriangleBlocks};
use crate::Kernel;
use crate::kernel::{Immediate, Packed};
use accel::{Nearest, Surface};
use lanes::packet::{Lanes, NearestPacket};
use lanes::{ROW, Simd, next_lane};

impl<K: Kernel> Search<K> for Immediate {}

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// Calls `found` with every hit among the set bits that satisfies the hit-in-padded-bounds invariant until it says to stop.
    #[inline(always)]
    pub(super) fn visit<S: Simd>(
        &self,
        s: S,
        mut set: Candidates<K>,
        ray: &OneRay<K>,
        mut t_max: f32,
        mut found: impl FnMut(u32, Surface) -> Option<f32>,
    ) {
        let mut scratch = Scratch::EMPTY;
        while let Some(Next { slot: first, wanted }) = set.next::<S>() {
            let packed = self.unpacked(s, first, &mut scratch.0);
            let lanes = K::triangles(s, &ray.prepared, packed, wanted, t_max);
            let mut hits = s.bits(lanes.hit) & wanted;
            if hits == 0 {
                continue;
            }
            let rows = lanes.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let surface = rows.surface(lane);
                if self.holds(Packed { lane: first % ROW + lane, ..packed }, first + lane, ray, surface) {
                    match found(self.ids.get(first + lane), surface) {
                        Some(limit) => t_max = limit,
                        None => return,
                    }
                }
            }
        }
    }

    #[inline(always)]
    pub(super) fn holds(&self, packed: Packed<'_>, slot: usize, ray: &OneRay<K>, surface: Surface) -> bool {
        let corners = self.corners(packed, slot);
        self.triangles.frame.holds(&corners, &ray.ray, ray.near, surface.t)
    }

    #[inline(always)]
    pub(super) fn offer_one(&self, ray: &OneRay<K>, object: u32, surface: Surface, best: &mut Nearest) {
        best.offer_by(object, surface, |other| self.triangles.precedes(&ray.ray, object, other));
    }

    /// Strikes the lanes off that break the hit-in-padded-bounds invariant: left are those that satisfy it plainly and whose
    /// origins are near, and those of the others that the full test lets pass.
    #[inline(always)]
    pub(super) fn held<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &Rays<K, S>,
        limits: &Limits,
        mut lanes: Lanes<S>,
    ) -> Lanes<S> {
        let hits = s.bits(lanes.hit);
        let plain = s.bits(s.and(rays.near, limits.hold(s, &rays.rays, lanes.t)));
        let mut undecided = hits & !plain;
        if undecided != 0 {
            let corners = self.corners_of(slot);
            let mut kept = hits & plain;
            let rows = lanes.rows(s);
            while let Some(lane) = next_lane(&mut undecided) {
                if self.triangles.frame.holds(&corners, &rays.rays.ray(s, lane), false, rows.surface(lane).t)
                {
                    kept |= 1 << lane;
                }
            }
            lanes.hit = s.mask(kept);
        }
        lanes
    }

    /// Offers the lanes that satisfy the hit-in-padded-bounds invariant.
    #[inline(always)]
    pub(super) fn offer<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &Rays<K, S>,
        limits: &Limits,
        lanes: Lanes<S>,
        best: &mut NearestPacket<S>,
    ) {
        let lanes = self.held(s, slot, rays, limits, lanes);
        best.offer(s, self.ids.get(slot), &lanes);
    }
}
