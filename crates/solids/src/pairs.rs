//! Rays and solids of a block in pairs, one pair in each lane.

use crate::blocks::{SolidBlocks, precedes};
use crate::exact_pairs::Waiting;
use crate::group::Kind;
use crate::paired::{Group, Rays, values};
use crate::rows::Packing;
use accel::{Nearest, Ray};
use lanes::packet::Pairs;
use lanes::{BLOCK, EMPTY_SLOT, ROW, Simd, next_lane};

impl SolidBlocks<'_> {
    /// Tests rays and objects in pairs: those of packed kinds and near rays in lanes, the others one by one.
    #[inline(always)]
    pub(crate) fn test_pairs<S: Simd>(&self, s: S, pairs: &Pairs<'_, S>, best: &mut [Nearest; ROW]) {
        let mut rays = Rays::of(s, pairs, &self.solids.frame, best);
        let (spheres, cones, triangles) = (
            self.spheres.block(pairs.block),
            self.cones.block(pairs.block),
            self.triangles.block(pairs.block),
        );
        let mut waiting = self.is_exact().then(|| Waiting::new(&rays.t_max));
        for at in (0..pairs.len).step_by(S::LANES) {
            let len = S::LANES.min(pairs.len - at);
            let group = Group { rays: &pairs.rays[at..], slots: &pairs.slots[at..], len };
            let near = group.of_rays(rays.near);
            let mut left = group.lanes(u64::MAX);
            let wanted = group.lanes(spheres) & near;
            if wanted != 0 {
                if let Some(waiting) = &mut waiting {
                    if waiting.is_full() {
                        self.settle(s, pairs, waiting, &mut rays, best);
                    }
                    waiting.add(s, &values(s, &self.spheres, pairs.block, &group), &group, wanted, &rays);
                } else {
                    self.kind_in_pairs(s, (&self.spheres, pairs.block), &group, wanted, &mut rays, best);
                }
                left &= !wanted;
            }
            let wanted = group.lanes(cones) & left & near;
            if wanted != 0 {
                self.kind_in_pairs(s, (&self.cones, pairs.block), &group, wanted, &mut rays, best);
                left &= !wanted;
            }
            let wanted = group.lanes(triangles) & left & near;
            if wanted != 0 {
                self.kind_in_pairs(s, (&self.triangles, pairs.block), &group, wanted, &mut rays, best);
                left &= !wanted;
            }
            while let Some(lane) = next_lane(&mut left) {
                let (slot, place) = group.pair(lane);
                let object = self.ids.get(pairs.block * BLOCK + slot);
                if object != EMPTY_SLOT && rays.t_max[place] != f32::NEG_INFINITY {
                    self.one_in_pair(object, &rays.rows.ray(place), &mut best[place]);
                    if best[place].object == object {
                        rays.found(place, best[place].t);
                    }
                }
            }
        }
        if let Some(waiting) = &mut waiting {
            self.settle(s, pairs, waiting, &mut rays, best);
        }
    }

    #[inline(never)]
    fn one_in_pair(&self, object: u32, ray: &Ray, best: &mut Nearest) {
        accel::Objects::closest(&self.solids, object, ray, best);
    }

    /// The wanted lanes, whose objects are all of a kind.
    #[inline(always)]
    fn kind_in_pairs<K: Packing, S: Simd>(
        &self,
        s: S,
        (kind, block): (&Kind<K>, usize),
        group: &Group,
        wanted: u32,
        rays: &mut Rays<S>,
        best: &mut [Nearest; ROW],
    ) {
        let (prepared, t_max) = rays.permuted(s, group);
        let found = K::test(s, &prepared, &values(s, kind, block, group), t_max);
        let mut hits = s.bits(found.lanes.hit) & wanted;
        if hits == 0 {
            return;
        }
        let plain = s.bits(found.plain);
        let rows = found.lanes.rows(s);
        while let Some(lane) = next_lane(&mut hits) {
            let (slot, place) = group.pair(lane);
            let object = self.ids.get(block * BLOCK + slot);
            let (t, best) = (rows.t[lane], &mut best[place]);
            if precedes(t, object, best)
                && (plain >> lane & 1 != 0 || self.solids.holds(object, &rays.rows.ray(place), t))
            {
                best.offer(object, rows.surface(lane));
                rays.found(place, t);
            }
        }
    }
}
