//! Rays and triangles in pairs, one in each lane, each decided at once.

use super::TriangleBlocks;
use super::frame::LimitLanes;
use super::pairs::PairRays;
use super::search::{Candidates, Search};
use crate::kernel::{Floats, InPairs, Paired};
use accel::{Nearest, Ray};
use lanes::packet::{Packet, Pairs};
use lanes::{Blocks, ROW, Simd, next_lane};

impl<K: Paired<Storage = Floats>> Search<K> for InPairs {
    const IN_PAIRS: bool = true;

    /// A ray's tests are all begun with the nearest hit that was known before those beside them.
    #[inline(always)]
    fn pairs<'s, S: Simd>(blocks: &TriangleBlocks<'s, K>, s: S, pairs: &Pairs<S>, best: &mut [Nearest; ROW])
    where
        TriangleBlocks<'s, K>: Blocks,
    {
        let frame = &blocks.triangles.frame;
        // Corners that the kernel sees elsewhere say nothing of where the mesh has them.
        let near = if blocks.rows_hold_corners() { s.bits(blocks.near(s, pairs.packet)) } else { 0 };
        let mut rays = PairRays::of(s, blocks, pairs, best);
        for at in (0..pairs.len).step_by(S::LANES) {
            let group = rays.group(s, blocks, pairs, at);
            let found = K::each(s, &group.rays, group.corners, group.t_max);
            let mut hits = s.bits(found.hit) & group.wanted;
            if hits == 0 {
                continue;
            }
            let limits = LimitLanes::of(s, frame, group.corners);
            let plain = s.bits(limits.hold(s, &group.packet(s, pairs), found.t));
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let ((slot, place), surface) = (group.pair(lane), found.surface(lane));
                let plain = plain >> lane & near >> place & 1 != 0;
                if plain || frame.holds(&blocks.corners_of(slot), &rays.ray(place), false, surface.t) {
                    best[place].offer(blocks.ids.get(slot), surface);
                    rays.found(place, pairs.any, best[place].t);
                }
            }
        }
    }

    #[inline(always)]
    fn in_place<S: Simd>(s: S, mut set: Candidates<K>, ray: &Ray, any: bool, best: &mut Nearest) {
        let blocks = set.blocks;
        let frame = &blocks.triangles.frame;
        let many = K::many(s, &frame.packet(s, &Packet::splat(s, ray)));
        while set.mask != 0 {
            let (chosen, len) = blocks.next_in_place::<S>(&mut set);
            if len == 0 {
                return;
            }
            let found = K::each(s, &many, blocks.corners_in_place(s, &chosen), s.splat(best.t));
            let mut hits = s.bits(found.hit) & (u32::MAX >> (32 - len));
            if hits == 0 {
                continue;
            }
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let (object, surface) = (chosen[lane], found.surface(lane));
                let corners = blocks.triangles.corners(object);
                if frame.holds(&corners, ray, frame.is_near(ray.origin), surface.t) {
                    best.offer(object, surface);
                    if any {
                        return;
                    }
                }
            }
        }
    }
}
