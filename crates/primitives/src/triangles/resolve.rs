//! Hits that waited, resolved.

use super::TriangleBlocks;
use super::pending::{PendingHit, load_nearest, marked, pending};
use super::search::OneRay;
use crate::kernel::{Deferral, Floats};
use accel::{Nearest, Ray, Surface};
use lanes::packet::{Lanes, NearestPacket, Packet, Vec3Lanes};
use lanes::{ROW, Scalar, Simd, next_lane};

impl<K: Deferral<Storage = Floats>> TriangleBlocks<'_, K> {
    /// Resolves the hit that waits, if one does.
    #[inline(always)]
    pub(super) fn resolve_one(&self, ray: &OneRay<K>, best: &mut Nearest) {
        if let Some(PendingHit { slot, .. }) = PendingHit::in_place_of(best) {
            let packet = self.triangles.frame.packet(Scalar, &Packet::splat(Scalar, &ray.ray));
            let Lanes { t, u, v, .. } =
                K::resolve(Scalar, &packet, self.packed(slot).splat_corners(Scalar), 1);
            *best = Nearest { t, object: self.ids.get(slot), u, v };
        }
    }

    /// Resolves the hits that wait of any number of rays.
    #[inline(always)]
    pub(super) fn resolve_rays<S: Simd>(&self, s: S, rays: &[Ray], best: &mut [Nearest]) {
        let whole = rays.len() / S::LANES * S::LANES;
        let (full, rest) = rays.split_at(whole);
        let (full_best, rest_best) = best.split_at_mut(whole);
        for (rays, best) in full.chunks_exact(S::LANES).zip(full_best.chunks_exact_mut(S::LANES)) {
            self.resolve_group(s, rays, best);
        }
        if let Some(ray) = rest.first() {
            let (mut rays, mut nearest) = ([*ray; ROW], [Nearest::new(0.0); ROW]);
            rays[..rest.len()].copy_from_slice(rest);
            nearest[..rest.len()].copy_from_slice(rest_best);
            self.resolve_group(s, &rays, &mut nearest);
            rest_best.copy_from_slice(&nearest[..rest.len()]);
        }
    }

    /// Resolves the hits that wait of the first `LANES` rays.
    #[inline(always)]
    fn resolve_group<S: Simd>(&self, s: S, rays: &[Ray], best: &mut [Nearest]) {
        let (rays, best) = (&rays[..S::LANES], &mut best[..S::LANES]);
        let [_, object, _, v] = load_nearest(s, best);
        let mut deferred = s.bits(marked(s, v));
        if deferred == 0 {
            return;
        }
        let mut objects = [0.0; ROW];
        s.store(object, &mut objects);
        let slots = objects.map(f32::to_bits);
        let mut chosen = [&rays[0]; ROW];
        for (chosen, ray) in chosen.iter_mut().zip(rays) {
            *chosen = ray;
        }
        let rays = self.triangles.frame.packet(s, &Packet::gather(s, &chosen));
        let found = K::resolve(s, &rays, self.corners_in(s, &slots, deferred), deferred).rows(s);
        while let Some(lane) = next_lane(&mut deferred) {
            let Surface { t, u, v } = found.surface(lane);
            best[lane] = Nearest { t, object: self.ids.get(slots[lane] as usize), u, v };
        }
    }

    /// Resolves the hits that wait in the lanes `which`.
    #[inline(always)]
    pub(super) fn resolve_lanes<S: Simd>(
        &self,
        s: S,
        rays: &Packet<S>,
        which: u32,
        best: &mut NearestPacket<S>,
    ) {
        let deferred = s.bits(pending(s, best)) & which;
        if deferred == 0 {
            return;
        }
        let mut slots = [0; ROW];
        s.store_u(best.object, &mut slots);
        let rays = self.triangles.frame.packet(s, rays);
        let found = K::resolve(s, &rays, self.corners_in(s, &slots, deferred), deferred);
        let mut left = deferred;
        while let Some(lane) = next_lane(&mut left) {
            slots[lane] = self.ids.get(slots[lane] as usize);
        }
        best.take_each(s, s.mask(deferred), &slots, &found);
    }

    /// The corners of the triangles in these slots, of the lanes `wanted`; the others hold zeros.
    #[inline(always)]
    fn corners_in<S: Simd>(&self, s: S, slots: &[u32; ROW], mut wanted: u32) -> [Vec3Lanes<S>; 3] {
        let mut all = [[s.splat(0.0); 3]; 3];
        // Into registers lane by lane: what is written to memory in small pieces can't be read at once for a while.
        while let Some(lane) = next_lane(&mut wanted) {
            let here = s.mask(1 << lane);
            let corners = self.packed(slots[lane] as usize).splat_corners(s);
            for (all, corner) in all.iter_mut().zip(corners) {
                for (all, value) in all.iter_mut().zip(corner) {
                    *all = s.select(here, value, *all);
                }
            }
        }
        all
    }
}
