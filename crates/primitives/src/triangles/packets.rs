//! What becomes of the hits of several rays on one triangle.

#[cfg(doc)]
use super::Frame;
use super::pending::{defer, pending};
use super::{Kernel, Limits, TriangleBlocks, TrianglePacket, next_lane};
use crate::kernel::Deferral;
use accel::Nearest;
use lanes::packet::{Bounds, Lanes, NearestPacket, Packet};
use lanes::{Blocks, ROW, Row, Simd};

/// As many rows as kernels pack, or more.
const MOST_ROWS: usize = 16;

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// Offers those lanes that satisfy the hit-in-padded-bounds invariant: those that do plainly and whose origins are near, and
    /// those of the others that the full test lets pass.
    #[inline(always)]
    pub(super) fn offer<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &TrianglePacket<S, K::Many<S>>,
        limits: &Limits,
        mut lanes: Lanes<S>,
        best: &mut NearestPacket<S>,
    ) {
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
        let object = self.ids.get(slot);
        if K::Deferral::DEFERS {
            self.take_ties(s, object, &mut lanes, &rays.rays, best);
        }
        best.offer(s, object, &lanes);
    }

    /// Decides the lanes that hit `object` at the same t as another object, and strikes them off `lanes`.
    #[inline(always)]
    fn take_ties<S: Simd>(
        &self,
        s: S,
        object: u32,
        lanes: &mut Lanes<S>,
        rays: &Packet<S>,
        best: &mut NearestPacket<S>,
    ) {
        let mut ties = s.bits(best.ties(s, object, lanes));
        if ties == 0 {
            return;
        }
        let decided = s.bits(lanes.hit) & !ties;
        let mut others = [Nearest::new(0.0); ROW];
        best.store(s, &mut others);
        let mut wins = 0;
        while let Some(lane) = next_lane(&mut ties) {
            let wins_here = self.triangles.precedes(&rays.ray(s, lane), object, others[lane].object);
            wins |= u32::from(wins_here) << lane;
        }
        best.take(s, s.mask(wins), object, lanes);
        lanes.hit = s.mask(decided);
    }

    /// Defers the certain hits that come before what is there for certain, and decides those that may. Certain hits of near
    /// rays satisfy the invariant, see [`Frame::is_near`].
    #[inline(always)]
    pub(super) fn defer<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &TrianglePacket<S, K::Many<S>>,
        bounds: &Bounds<S>,
        best: &mut NearestPacket<S>,
    ) {
        let deferred = defer(s, slot, s.and(bounds.certain, rays.near), bounds, best);
        let undecided = s.bits(bounds.undecided) & !s.bits(deferred);
        if undecided != 0 {
            self.decide(s, slot, rays, undecided, best);
        }
    }

    #[inline(always)]
    fn decide<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &TrianglePacket<S, K::Many<S>>,
        undecided: u32,
        best: &mut NearestPacket<S>,
    ) {
        let lanes = K::Deferral::decide(s, &rays.prepared, self.packed(slot), slot % ROW, undecided, best.t);
        let hits = s.bits(lanes.hit);
        if hits != 0 {
            self.resolve_lanes(s, rays, hits, best);
            let limits = Limits::of(&self.triangles.frame, &self.corners_of(slot));
            self.offer(s, slot, rays, &limits, lanes, best);
        }
    }

    /// Resolves the pending hits of the lanes `which`; `best` holds their slots.
    #[inline(always)]
    pub(super) fn resolve_lanes<S: Simd>(
        &self,
        s: S,
        rays: &TrianglePacket<S, K::Many<S>>,
        which: u32,
        best: &mut NearestPacket<S>,
    ) {
        const { assert!(K::ROWS <= MOST_ROWS) };
        let deferred = s.bits(pending(s, best)) & which;
        if deferred == 0 {
            return;
        }
        let mut slots = [0; ROW];
        s.store_u(best.object, &mut slots);
        let mut group = [Row([0.0; ROW]); MOST_ROWS];
        let mut left = deferred;
        while let Some(lane) = next_lane(&mut left) {
            let slot = slots[lane] as usize;
            for (to, from) in group.iter_mut().zip(self.packed(slot)) {
                to.0[lane] = from.0[slot % ROW];
            }
            slots[lane] = self.object(slot);
        }
        let rays = self.triangles.frame.packet(s, &rays.rays);
        let found = K::Deferral::resolve(s, &rays, &group[..K::ROWS], deferred);
        best.take_each(s, s.mask(deferred), &slots, &found);
    }
}
