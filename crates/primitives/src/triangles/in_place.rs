//! Triangles that are tested where the scene has them: blocks that copy nothing but numbers.

use super::{TriangleBlocks, next_lane};
use crate::Kernel;
use accel::{Nearest, Objects, Ray};
use lanes::packet::{Lanes, NearestPacket, Packet, Pairs, RayRows};
use lanes::{BLOCK, EMPTY_SLOT, ROW, Simd};

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// `LANES` rays, each against the triangle in its own lane, with the corners as the mesh holds them.
    #[inline(always)]
    fn each_in_place<S: Simd>(&self, s: S, ids: &[u32; ROW], rays: &Packet<S>, t_max: S::F) -> Lanes<S> {
        let (mesh, frame) = (&self.triangles.mesh, &self.triangles.frame);
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

    /// One ray against the triangles of a block whose bits are set; with `any` until the first hit.
    #[inline(always)]
    pub(super) fn one_in_place<S: Simd>(
        &self,
        s: S,
        block: usize,
        mut mask: u64,
        ray: &Ray,
        any: bool,
        best: &mut Nearest,
    ) {
        if !K::EACH {
            while mask != 0 && !(any && best.object != Nearest::NONE) {
                let object = self.ids.get(block * BLOCK + mask.trailing_zeros() as usize);
                mask &= mask - 1;
                if object != EMPTY_SLOT {
                    self.triangles.closest(object, ray, best);
                }
            }
            return;
        }
        let rays = Packet::splat(s, ray);
        while mask != 0 {
            let (mut chosen, mut len) = ([0; ROW], 0);
            while mask != 0 && len < S::LANES {
                let object = self.ids.get(block * BLOCK + mask.trailing_zeros() as usize);
                mask &= mask - 1;
                if object != EMPTY_SLOT {
                    chosen[len] = object;
                    len += 1;
                }
            }
            if len == 0 {
                return;
            }
            let found = self.each_in_place(s, &chosen, &rays, s.splat(best.t));
            let mut hits = s.bits(found.hit) & (u32::MAX >> (32 - len));
            if hits == 0 {
                continue;
            }
            let found = found.rows(s);
            while let Some(lane) = next_lane(&mut hits) {
                let surface = found.surface(lane);
                if self.holds_in_place(chosen[lane], ray, surface.t) {
                    best.offer(chosen[lane], surface);
                    if any {
                        return;
                    }
                }
            }
        }
    }

    /// [`lanes::Blocks::pairs`].
    #[inline(always)]
    pub(super) fn pairs_in_place<S: Simd>(
        &self,
        s: S,
        block: usize,
        pairs: &Pairs,
        lanes: &Packet<S>,
        any: bool,
        best: &mut [Nearest; ROW],
    ) {
        let rows = RayRows::of(s, lanes);
        let mut t_max = [0.0; ROW];
        for (t_max, best) in t_max.iter_mut().zip(&*best) {
            *t_max = best.t;
        }
        for at in (0..pairs.len).step_by(S::LANES) {
            let len = S::LANES.min(pairs.len - at);
            let slots = &pairs.slots[at..at + len];
            let mut chosen = [self.ids.get(block * BLOCK + usize::from(slots[0])); ROW];
            for (chosen, slot) in chosen.iter_mut().zip(slots) {
                *chosen = self.ids.get(block * BLOCK + usize::from(*slot));
            }
            let ray = s.load_bytes(&pairs.rays[at..]);
            let t = s.permute(s.load(&t_max), ray);
            let found = self.each_in_place(s, &chosen, &lanes.permuted(s, ray), t);
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
                    t_max[place] = if any { f32::NEG_INFINITY } else { best[place].t };
                }
            }
        }
    }

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
