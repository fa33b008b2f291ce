//! Tests of kernels that tell what is certain: hits wait until the nearest is known.

use super::TriangleBlocks;
#[cfg(doc)]
use super::frame::Frame;
use super::frame::Limits;
use super::pairs::PairRays;
use super::pending::{Floors, PendingHit, defer, lower_bound};
use super::search::{Candidates, Next, OneRay, PreparedSlot, Rays, Search, Slot};
use crate::kernel::{Deferral, Deferred, Floats, Packed};
use accel::{Nearest, Objects, Ray, Surface};
use lanes::packet::{Bounds, Lanes, NearestPacket, Packet, Pairs};
use lanes::{Blocks, ROW, Row, Scalar, Simd, next_lane};

impl<K: Deferral<Storage = Floats>> Search<K> for Deferred {
    const LIMIT_ROWS: usize = 0;

    /// Lets the nearest of the certain hits wait, and decides what may come before it.
    #[inline(always)]
    fn closest<S: Simd>(s: S, mut set: Candidates<K>, ray: &OneRay<K>, best: &mut Nearest) {
        let blocks = set.blocks;
        while let Some(Next { slot: first, wanted }) = set.next::<S>() {
            let bounds = K::bounds_one(s, &ray.prepared, blocks.packed(first), wanted, best.t);
            let mut undecided = s.bits(bounds.undecided) & wanted;
            if undecided == 0 {
                continue;
            }
            let (mut low, mut high) = ([0.0; ROW], [0.0; ROW]);
            s.store(bounds.low, &mut low);
            s.store(bounds.high, &mut high);
            let mut certain = if ray.near { undecided & s.bits(bounds.certain) } else { 0 };
            while let Some(lane) = next_lane(&mut certain) {
                if high[lane] < lower_bound(best) {
                    PendingHit { slot: first + lane, low: low[lane], high: high[lane] }.wait(best);
                    undecided &= !(1 << lane);
                }
            }
            while let Some(lane) = next_lane(&mut undecided) {
                let known = PendingHit::in_place_of(best).is_some_and(|pending| pending.slot == first + lane);
                let behind = low[lane] > best.t;
                if !known && !behind {
                    blocks.decide_one(ray, first + lane, high[lane], best);
                }
            }
        }
    }

    /// A certain hit needs no decision.
    #[inline(always)]
    fn any<S: Simd>(s: S, mut set: Candidates<K>, ray: &OneRay<K>, t_max: f32) -> bool {
        let blocks = set.blocks;
        while let Some(Next { slot: first, wanted }) = set.next::<S>() {
            let bounds = K::bounds_one(s, &ray.prepared, blocks.packed(first), wanted, t_max);
            let mut undecided = s.bits(bounds.undecided) & wanted;
            if undecided == 0 {
                continue;
            }
            let certain = s.and(bounds.certain, s.lt(bounds.high, s.splat(t_max)));
            if ray.near && s.bits(certain) & wanted != 0 {
                return true;
            }
            while let Some(lane) = next_lane(&mut undecided) {
                if blocks.decided(ray, first + lane, t_max).is_some() {
                    return true;
                }
            }
        }
        false
    }

    const IN_PAIRS: bool = true;

    /// As [`Search::closest`] does with each ray.
    #[inline(always)]
    fn pairs<'s, S: Simd>(blocks: &TriangleBlocks<'s, K>, s: S, pairs: &Pairs<S>, best: &mut [Nearest; ROW])
    where
        TriangleBlocks<'s, K>: Blocks,
    {
        let near = if blocks.in_place { 0 } else { s.bits(blocks.near(s, pairs.packet)) };
        let mut rays = PairRays::of(s, blocks, pairs, best);
        let mut floors = Floors::of(s, best);
        for at in (0..pairs.len).step_by(S::LANES) {
            let group = rays.group(s, blocks, pairs, at);
            let sizes = if blocks.in_place {
                K::sizes(s, group.corners)
            } else {
                group.row(s, blocks, pairs.block, K::SIZE_ROW)
            };
            let bounds = K::bounds_each(s, &group.rays, group.corners, sizes, group.wanted, group.t_max);
            let mut undecided = s.bits(bounds.undecided) & group.wanted;
            if undecided == 0 {
                continue;
            }
            let (mut low, mut high) = ([0.0; ROW], [0.0; ROW]);
            s.store(bounds.low, &mut low);
            s.store(bounds.high, &mut high);
            let certain = s.bits(bounds.certain);
            while let Some(lane) = next_lane(&mut undecided) {
                let (slot, place) = group.pair(lane);
                let hit = PendingHit { slot, low: low[lane], high: high[lane] };
                if hit.low > rays.t_max(place) {
                    continue;
                }
                let best = &mut best[place];
                let certain = certain >> lane & near >> place & 1 != 0;
                if certain && hit.high < floors.0[place] {
                    hit.wait(best);
                } else {
                    blocks.compare_pair(&rays.ray(place), hit, certain, best);
                }
                if best.object != Nearest::NONE {
                    rays.found(place, pairs.any, best.t);
                    floors.0[place] = lower_bound(best);
                }
            }
        }
    }

    #[inline(always)]
    fn in_place<S: Simd>(s: S, mut set: Candidates<K>, ray: &Ray, any: bool, best: &mut Nearest) {
        let blocks = set.blocks;
        let many = K::many(s, &blocks.triangles.frame.packet(s, &Packet::splat(s, ray)));
        while set.mask != 0 {
            let (chosen, len) = blocks.next_in_place::<S>(&mut set);
            if len == 0 {
                return;
            }
            let (corners, wanted) = (blocks.corners_in_place(s, &chosen), u32::MAX >> (32 - len));
            let sizes = K::sizes(s, corners);
            let bounds = K::bounds_each(s, &many, corners, sizes, wanted, s.splat(best.t));
            let mut undecided = s.bits(bounds.undecided) & wanted;
            while let Some(lane) = next_lane(&mut undecided) {
                blocks.triangles.closest(chosen[lane], ray, best);
                if any && best.object != Nearest::NONE {
                    return;
                }
            }
        }
    }

    #[inline(always)]
    fn offer<S: Simd>(
        blocks: &TriangleBlocks<K>,
        s: S,
        object: u32,
        mut lanes: Lanes<S>,
        rays: &Packet<S>,
        best: &mut NearestPacket<S>,
    ) {
        blocks.take_ties(s, object, &mut lanes, rays, best);
        best.offer(s, object, &lanes);
    }

    #[inline(always)]
    fn resolve_each<S: Simd>(blocks: &TriangleBlocks<K>, s: S, rays: &[Ray], best: &mut [Nearest]) {
        blocks.resolve_rays(s, rays, best);
    }

    #[inline(always)]
    fn resolve(blocks: &TriangleBlocks<K>, ray: &OneRay<K>, best: &mut Nearest) {
        blocks.resolve_one(ray, best);
    }

    #[inline(always)]
    fn packet<S: Simd>(s: S, one: Slot<K>, rays: &Rays<K, S>, best: &mut NearestPacket<S>) {
        let Slot { blocks, slot } = one;
        let bounds = K::bounds(s, &rays.prepared, blocks.packed(slot), best.t);
        blocks.defer(s, slot, rays, &bounds, best);
    }

    /// Hits that are certain need no limits.
    #[inline(always)]
    fn limits<S: Simd>(_: &TriangleBlocks<K>, _: S, _: usize, _: Packed<'_>, _: &mut [Row]) {}

    #[inline(always)]
    fn packet_prepared<S: Simd>(s: S, one: PreparedSlot<K>, rays: &Rays<K, S>, best: &mut NearestPacket<S>) {
        let bounds = K::bounds_prepared(s, &rays.prepared, one.prepared, best.t);
        one.at.blocks.defer(s, one.at.slot, rays, &bounds, best);
    }

    #[inline(always)]
    fn resolve_packet<S: Simd>(of: &TriangleBlocks<K>, s: S, rays: &Rays<K, S>, best: &mut NearestPacket<S>) {
        of.resolve_lanes(s, &rays.rays, u32::MAX, best);
    }
}

impl<K: Deferral<Storage = Floats>> TriangleBlocks<'_, K> {
    /// The triangle in a slot.
    #[inline(always)]
    pub(super) fn packed(&self, slot: usize) -> Packed<'_> {
        Packed::new(self.units(slot), slot % ROW)
    }

    /// Decides one test, and where it hits the hit that waits too, unless that comes after it for certain.
    #[inline(always)]
    fn decide_one(&self, ray: &OneRay<K>, slot: usize, high: f32, best: &mut Nearest) {
        if let Some(surface) = self.decided(ray, slot, best.t) {
            let before = high < lower_bound(best);
            if !before {
                self.resolve_one(ray, best);
            }
            self.offer_one(ray, self.ids.get(slot), surface, best);
        }
    }

    /// Finds out whether a hit of a ray that isn't prepared, if it is one, comes before the one that is known.
    #[inline(never)]
    fn compare_pair(&self, ray: &Ray, hit: PendingHit, certain: bool, best: &mut Nearest) {
        if let Some(known) = PendingHit::in_place_of(best)
            && (known.slot == hit.slot || certain && self.at_one_t(hit, known, best))
        {
            return;
        }
        if self.in_place {
            return self.triangles.closest(self.ids.get(hit.slot), ray, best);
        }
        self.decide_one(&self.prepare_one(ray), hit.slot, hit.high, best);
    }

    /// Where both hits are at one t, whatever that is, lets the one wait that comes first.
    #[inline(always)]
    fn at_one_t(&self, hit: PendingHit, known: PendingHit, best: &mut Nearest) -> bool {
        if !K::at_one_t(&self.corners_of(hit.slot), &self.corners_of(known.slot)) {
            return false;
        }
        let first = if self.ids.get(hit.slot) < self.ids.get(known.slot) { hit.slot } else { known.slot };
        PendingHit { slot: first, low: hit.low.max(known.low), high: hit.high.min(known.high) }.wait(best);
        true
    }

    /// The hit on the triangle in a slot.
    #[inline(always)]
    fn decided(&self, ray: &OneRay<K>, slot: usize, t_max: f32) -> Option<Surface> {
        let packed = self.packed(slot);
        let lanes = K::decide_one(Scalar, &ray.prepared, packed, 1, t_max);
        let surface = Surface { t: lanes.t, u: lanes.u, v: lanes.v };
        (lanes.hit && self.holds(packed, slot, ray, surface)).then_some(surface)
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
    fn defer<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &Rays<K, S>,
        bounds: &Bounds<S>,
        best: &mut NearestPacket<S>,
    ) {
        if s.bits(bounds.undecided) == 0 {
            return;
        }
        let deferred = defer(s, slot, s.and(bounds.certain, rays.near), bounds, best);
        let undecided = s.bits(bounds.undecided) & !s.bits(deferred);
        if undecided == 0 {
            return;
        }
        let lanes = K::decide(s, &rays.prepared, self.packed(slot), undecided, best.t);
        let hits = s.bits(lanes.hit);
        if hits != 0 {
            self.resolve_lanes(s, &rays.rays, hits, best);
            let limits = Limits::of(&self.triangles.frame, &self.corners_of(slot));
            let lanes = self.held(s, slot, rays, &limits, lanes);
            Deferred::offer(self, s, self.ids.get(slot), lanes, &rays.rays, best);
        }
    }
}
