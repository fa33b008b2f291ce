//! One ray against triangles in lanes.

use super::pending::{PendingHit, lower_bound};
use super::{Kernel, Scratch, TriangleBlocks, TriangleRay, next_lane};
use crate::kernel::Deferral;
use accel::{Nearest, Surface};
use lanes::{BLOCK, Blocks, ROW, Row, Scalar, Simd};

/// The next triangles of a block to be tested at once.
struct Next {
    /// Their first slot.
    slot: usize,
    /// Bits of those that are wanted.
    wanted: u32,
}

/// Takes them off `mask`.
#[inline(always)]
fn next<S: Simd>(block: usize, mask: &mut u64) -> Option<Next> {
    if *mask == 0 {
        return None;
    }
    let lanes_mask = u64::MAX >> (64 - S::LANES);
    let first = mask.trailing_zeros() as usize / S::LANES * S::LANES;
    let wanted = (*mask >> first & lanes_mask) as u32;
    *mask &= !(lanes_mask << first);
    Some(Next { slot: block * BLOCK + first, wanted })
}

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// Calls `found` with every hit among the set bits that satisfies the hit-in-padded-bounds invariant until it says to stop.
    #[inline(always)]
    pub(super) fn visit<S: Simd>(
        &self,
        s: S,
        block: usize,
        mut mask: u64,
        ray: &TriangleRay<K::One>,
        mut t_max: f32,
        mut found: impl FnMut(u32, Surface) -> Option<f32>,
    ) {
        let mut scratch = Scratch::EMPTY;
        while let Some(Next { slot: first, wanted }) = next::<S>(block, &mut mask) {
            let group = self.group(s, first, &mut scratch);
            let lanes = K::triangles(s, &ray.prepared, group, first % ROW, wanted, t_max);
            let mut hits = s.bits(lanes.hit) & wanted;
            if hits == 0 {
                continue;
            }
            let rows = lanes.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let surface = rows.surface(lane);
                if self.holds(group, first + lane, ray, surface) {
                    match found(self.ids.get(first + lane), surface) {
                        Some(limit) => t_max = limit,
                        None => return,
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn holds(&self, group: &[Row], slot: usize, ray: &TriangleRay<K::One>, surface: Surface) -> bool {
        let corners = self.corners(group, slot);
        self.triangles.frame.holds(&corners, &ray.ray, ray.near, surface.t)
    }

    #[inline(always)]
    pub(super) fn offer_one(
        &self,
        ray: &TriangleRay<K::One>,
        object: u32,
        surface: Surface,
        best: &mut Nearest,
    ) {
        best.offer_by(object, surface, |other| self.triangles.precedes(&ray.ray, object, other));
    }

    /// Lets the nearest of the certain hits wait, and decides what may come before it.
    #[inline(always)]
    pub(super) fn defer_nearest<S: Simd>(
        &self,
        s: S,
        block: usize,
        mut mask: u64,
        ray: &TriangleRay<K::One>,
        best: &mut Nearest,
    ) {
        while let Some(Next { slot: first, wanted }) = next::<S>(block, &mut mask) {
            let group = self.packed(first);
            let bounds = K::Deferral::triangles_bounds(s, &ray.prepared, group, first % ROW, wanted, best.t);
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
                    self.decide_one(ray, first + lane, high[lane], best);
                }
            }
        }
    }

    /// Decides one test, and where it hits the hit that waits too, unless that comes after it for certain.
    #[inline(always)]
    fn decide_one(&self, ray: &TriangleRay<K::One>, slot: usize, high: f32, best: &mut Nearest) {
        if let Some(surface) = self.decided(ray, slot, best.t) {
            let before = high < lower_bound(best);
            if !before {
                self.resolve_one(ray, best);
            }
            self.offer_one(ray, self.ids.get(slot), surface, best);
        }
    }

    /// The hit on the triangle in a slot.
    #[inline(always)]
    fn decided(&self, ray: &TriangleRay<K::One>, slot: usize, t_max: f32) -> Option<Surface> {
        let group = self.packed(slot);
        let lanes = K::Deferral::triangles_decided(Scalar, &ray.prepared, group, slot % ROW, 1, t_max);
        let surface = Surface { t: lanes.t, u: lanes.u, v: lanes.v };
        (lanes.hit && self.holds(group, slot, ray, surface)).then_some(surface)
    }

    /// Resolves the hit that waits, if one does.
    #[inline(always)]
    pub(super) fn resolve_one(&self, ray: &TriangleRay<K::One>, best: &mut Nearest) {
        if let Some(PendingHit { slot, .. }) = PendingHit::in_place_of(best) {
            let group = self.packed(slot);
            let lanes =
                K::Deferral::triangles_decided(Scalar, &ray.prepared, group, slot % ROW, 1, ray.ray.t_max);
            debug_assert!(lanes.hit, "a certain hit");
            *best = Nearest { t: lanes.t, object: self.object(slot), u: lanes.u, v: lanes.v };
        }
    }

    /// Whether there is a hit; a certain one needs no decision.
    #[inline(always)]
    pub(super) fn any_certain<S: Simd>(
        &self,
        s: S,
        block: usize,
        mut mask: u64,
        ray: &TriangleRay<K::One>,
        t_max: f32,
    ) -> bool {
        while let Some(Next { slot: first, wanted }) = next::<S>(block, &mut mask) {
            let bounds = K::Deferral::triangles_bounds(
                s,
                &ray.prepared,
                self.packed(first),
                first % ROW,
                wanted,
                t_max,
            );
            let mut undecided = s.bits(bounds.undecided) & wanted;
            if undecided == 0 {
                continue;
            }
            let certain = s.and(bounds.certain, s.lt(bounds.high, s.splat(t_max)));
            if ray.near && s.bits(certain) & wanted != 0 {
                return true;
            }
            while let Some(lane) = next_lane(&mut undecided) {
                if self.decided(ray, first + lane, t_max).is_some() {
                    return true;
                }
            }
        }
        false
    }
}
