//! Beams through the levels.

use super::General;
use super::beam::{Beam, BeamRays};
use super::ready::{Ready, Room, Waiting, rows};
use super::stream::visit;
use super::traveller::{LIMIT, Traveller};
use super::tree::Node;
use accel::grid::Span;
use accel::{Count, Nearest, Ray};
use lanes::{BLOCK, Blocks, PackedObjects, ROW, Simd};

impl<O: PackedObjects> General<O> {
    /// Takes the beams of one octant through all that they meet.
    #[inline(always)]
    pub(super) fn drain_beams<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        octant: usize,
        ready: &Ready,
        top: u32,
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        let Room { beams, beam_rays, lists, stack, spans, best, .. } = room;
        let negative = [octant & 1 != 0, octant & 2 != 0, octant & 4 != 0];
        let (first, len) = (ready.first_beam, ready.beams);
        stack.push(Waiting { what: 0, first, len, top });
        while let Some(next) = stack.pop() {
            if next.what & Node::BLOCK == 0 {
                count.cells(u64::from(next.len));
                visit(s, &self.nodes[next.what as usize], &negative, next, beams, lists, stack);
                for waiting in stack.iter().rev().take(2) {
                    self.ask_for(waiting.what);
                }
            } else {
                count.blocks(u64::from(next.len));
                let block = (next.what & !Node::BLOCK) as usize;
                for id in &lists[next.first as usize..(next.first + next.len) as usize] {
                    let (beam, rays) = (&mut beams[usize::from(*id)], &mut beam_rays[usize::from(*id)]);
                    self.meet::<S, C, ANY>(s, block, beam, rays, spans, count);
                }
            }
        }
        for id in &lists[first as usize..(first + len) as usize] {
            let (beam, rays) = (&beams[usize::from(*id)], &mut beam_rays[usize::from(*id)]);
            self.end::<S, ANY>(s, rays, &mut best[beam.first as usize..]);
        }
    }

    /// Resolves what was found for a beam's rays.
    #[inline(always)]
    fn end<S: Simd, const ANY: bool>(&self, s: S, rays: &BeamRays, best: &mut [Nearest]) {
        let mut nearest = [Nearest::new(0.0); ROW];
        for at in (0..ROW).step_by(S::LANES) {
            let mut found = rays.nearest(s, at);
            if !ANY {
                let many = self.objects.many(s, &rays.packet(s, at));
                self.objects.resolve_packet(s, &many, &mut found);
            }
            found.store(s, &mut nearest[at..]);
        }
        for (best, nearest) in best.iter_mut().zip(&nearest) {
            if nearest.object != Nearest::NONE {
                *best = *nearest;
            }
        }
    }

    /// Tests all rays with all objects, which are in one block.
    #[inline(always)]
    pub(super) fn test_all<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        rays: &[Ray],
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        let best = &mut room.best;
        best.clear();
        best.resize(rays.len(), Nearest::new(0.0));
        for (rays, best) in rays.chunks(ROW).zip(best.chunks_mut(ROW)) {
            count.tests((rays.len() * self.len) as u64);
            let mut rays = BeamRays::new(rows(s, rays), u32::MAX >> (32 - rays.len()));
            for at in (0..ROW).step_by(S::LANES) {
                let mut nearest = rays.nearest(s, at);
                let many = self.objects.many(s, &rays.packet(s, at));
                for slot in 0..self.len {
                    self.objects.packet(s, slot, &many, &mut nearest);
                }
                rays.set(s, at, &nearest);
            }
            self.end::<S, ANY>(s, &rays, best);
        }
    }

    /// Tests the rays of a beam with the objects of a block.
    #[inline(always)]
    fn meet<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        block: usize,
        beam: &mut Beam,
        rays: &mut BeamRays,
        spans: &[Span],
        count: &mut C,
    ) {
        if beam.near.start[3] < 0.0 {
            return;
        }
        let candidates = beam.candidates(s, &self.maps[block]);
        count.candidates(u64::from(candidates.count_ones()));
        if candidates == 0 {
            return;
        }
        let mut limit = Traveller::DONE;
        for at in (0..ROW).step_by(S::LANES) {
            let mut best = rays.nearest(s, at);
            let off = s.splat(f32::NEG_INFINITY);
            let mut on = s.bits(s.lt(off, best.t));
            if on == 0 {
                continue;
            }
            let many = self.objects.many(s, &rays.packet(s, at));
            let mut left = candidates;
            while left != 0 && on != 0 {
                let slot = left.trailing_zeros() as usize;
                left &= left - 1;
                count.tests(u64::from(on.count_ones()));
                self.objects.packet(s, block * BLOCK + slot, &many, &mut best);
                if ANY {
                    let hit = s.lt_u(best.object, s.splat_u(Nearest::NONE));
                    best.t = s.select(hit, off, best.t);
                    on = s.bits(s.lt(off, best.t));
                }
            }
            rays.set(s, at, &best);
            if ANY {
                if on != 0 {
                    limit = beam.near.start[3];
                }
                continue;
            }
            // What a ray's nearest hit allows; where there is none yet, all.
            let mut lanes = on;
            while lanes != 0 {
                let lane = at + lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let here = if rays.object[lane] == Nearest::NONE {
                    LIMIT
                } else {
                    spans[beam.first as usize + lane].limit(rays.t[lane])
                };
                limit = limit.max(here);
            }
        }
        beam.near.start[3] = limit;
    }
}
