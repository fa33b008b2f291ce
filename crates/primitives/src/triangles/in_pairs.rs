//! Rays and triangles in pairs, one in each lane.

use super::search::{Candidates, Search};
use super::{CORNER_ROWS, TriangleBlocks, next_lane};
use crate::kernel::{Floats, InPairs, Paired};
use accel::{Nearest, Ray};
use lanes::packet::{Lanes, Packet, Pairs, RayRows};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, ROW, Simd};

impl<K: Paired<Storage = Floats>> Search<K> for InPairs {
    const IN_PAIRS: bool = true;

    /// A ray's tests are all begun with the nearest hit that was known before those beside them.
    #[inline(always)]
    fn pairs<'s, S: Simd>(blocks: &TriangleBlocks<'s, K>, s: S, pairs: &Pairs<S>, best: &mut [Nearest; ROW])
    where
        TriangleBlocks<'s, K>: Blocks,
    {
        const { assert!(K::ROWS == CORNER_ROWS, "the kernel packs corners") };
        if blocks.in_place {
            return blocks.pairs_in_place(s, pairs, best);
        }
        let frame = &blocks.triangles.frame;
        let scaled = frame.packet(s, pairs.packet);
        let rows = RayRows::of(s, pairs.packet);
        let mut t_max = [0.0; ROW];
        for (t_max, best) in t_max.iter_mut().zip(&*best) {
            *t_max = best.t;
        }
        let first = pairs.block * (BLOCK / ROW) * CORNER_ROWS;
        let packed = &blocks.units[first..first + BLOCK / ROW * CORNER_ROWS];
        for at in (0..pairs.len).step_by(S::LANES) {
            let left = pairs.len - at;
            let wanted = if left < S::LANES { (1 << left) - 1 } else { u32::MAX };
            let (ray_places, slots) = (&pairs.rays[at..], &pairs.slots[at..]);
            let slot = s.load_bytes(slots);
            let ray = s.load_bytes(ray_places);
            let mut corners = [[s.splat(0.0); 3]; 3];
            for (corner, values) in corners.iter_mut().enumerate() {
                for (axis, value) in values.iter_mut().enumerate() {
                    let row = &packed[3 * corner + axis..];
                    *value = s.lookup([&row[0], &row[9], &row[18], &row[27]], slot);
                }
            }
            let found = K::each(s, &scaled.permuted(s, ray), corners, s.permute(s.load(&t_max), ray));
            let mut hits = s.bits(found.hit) & wanted;
            if hits == 0 {
                continue;
            }
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let (slot, place) =
                    (pairs.block * BLOCK + usize::from(slots[lane]), usize::from(ray_places[lane]));
                let surface = found.surface(lane);
                let ray = rows.ray(place);
                let corners = blocks.corners_of(slot);
                if frame.holds(&corners, &ray, frame.is_near(ray.origin), surface.t) {
                    best[place].offer(blocks.ids.get(slot), surface);
                    t_max[place] = if pairs.any { f32::NEG_INFINITY } else { best[place].t };
                }
            }
        }
    }

    #[inline(always)]
    fn in_place<S: Simd>(
        blocks: &TriangleBlocks<K>,
        s: S,
        set: Candidates,
        ray: &Ray,
        any: bool,
        best: &mut Nearest,
    ) {
        let mut mask = set.mask;
        let rays = Packet::splat(s, ray);
        while mask != 0 {
            let (mut chosen, mut len) = ([0; ROW], 0);
            while mask != 0 && len < S::LANES {
                let object = blocks.ids.get(set.block * BLOCK + mask.trailing_zeros() as usize);
                mask &= mask - 1;
                if object != EMPTY_SLOT {
                    chosen[len] = object;
                    len += 1;
                }
            }
            if len == 0 {
                return;
            }
            let found = blocks.each_in_place(s, &chosen, &rays, s.splat(best.t));
            let mut hits = s.bits(found.hit) & (u32::MAX >> (32 - len));
            if hits == 0 {
                continue;
            }
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let surface = found.surface(lane);
                if blocks.holds_in_place(chosen[lane], ray, surface.t) {
                    best.offer(chosen[lane], surface);
                    if any {
                        return;
                    }
                }
            }
        }
    }
}

impl<K: Paired> TriangleBlocks<'_, K> {
    /// `LANES` rays, each against the triangle in its own lane, with the corners as the mesh holds them.
    #[inline(always)]
    fn each_in_place<S: Simd>(&self, s: S, ids: &[u32; ROW], rays: &Packet<S>, t_max: S::F) -> Lanes<S> {
        let (mesh, frame) = (&self.triangles.shape.mesh, &self.triangles.frame);
        let mut quads = [[[0.0; 4]; ROW]; 3];
        for (lane, id) in ids.iter().enumerate().take(S::LANES) {
            for (quads, corner) in quads.iter_mut().zip(mesh.corners(*id as usize)) {
                quads[lane] = [corner.x, corner.y, corner.z, 0.0];
            }
        }
        let mut corners = [rays.origin; 3];
        for (corner, quads) in corners.iter_mut().zip(&quads) {
            let mut places = [&quads[0]; ROW];
            for (place, quad) in places.iter_mut().zip(quads) {
                *place = quad;
            }
            let [x, y, z, _] = s.load_quads(&places);
            *corner = [x, y, z];
            if frame.scale != 1.0 {
                for value in corner {
                    *value = s.mul(*value, s.splat(frame.scale));
                }
            }
        }
        K::each(s, &frame.packet(s, rays), corners, t_max)
    }

    #[inline(always)]
    fn holds_in_place(&self, id: u32, ray: &Ray, t: f32) -> bool {
        let frame = &self.triangles.frame;
        frame.holds(&self.triangles.corners(id), ray, frame.is_near(ray.origin), t)
    }

    #[inline(always)]
    fn pairs_in_place<S: Simd>(&self, s: S, pairs: &Pairs<S>, best: &mut [Nearest; ROW]) {
        let rows = RayRows::of(s, pairs.packet);
        let mut t_max = [0.0; ROW];
        for (t_max, best) in t_max.iter_mut().zip(&*best) {
            *t_max = best.t;
        }
        for at in (0..pairs.len).step_by(S::LANES) {
            let len = S::LANES.min(pairs.len - at);
            let slots = &pairs.slots[at..at + len];
            let mut chosen = [self.ids.get(pairs.block * BLOCK + usize::from(slots[0])); ROW];
            for (chosen, slot) in chosen.iter_mut().zip(slots) {
                *chosen = self.ids.get(pairs.block * BLOCK + usize::from(*slot));
            }
            let ray = s.load_bytes(&pairs.rays[at..]);
            let t = s.permute(s.load(&t_max), ray);
            let found = self.each_in_place(s, &chosen, &pairs.packet.permuted(s, ray), t);
            let mut hits = s.bits(found.hit) & (u32::MAX >> (32 - len));
            if hits == 0 {
                continue;
            }
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let place = usize::from(pairs.rays[at + lane]) % ROW;
                let surface = found.surface(lane);
                if self.holds_in_place(chosen[lane], &rows.ray(place), surface.t) {
                    best[place].offer(chosen[lane], surface);
                    t_max[place] = if pairs.any { f32::NEG_INFINITY } else { best[place].t };
                }
            }
        }
    }
}
