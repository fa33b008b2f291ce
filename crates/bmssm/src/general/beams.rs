//! Beams through the levels.

use super::General;
use super::beam::{Beam, BeamRays};
use super::boxes::BlockBoxes;
use super::maps::BlockMaps;
use super::ready::Ready;
use super::scratch::{Scratch, Waiting};
use super::state::{LIMIT, TraversalState};
use super::test::{ResolveBeam, TestBeam, Tested};
use super::tree::Node;
use super::visit::Visit;
use accel::grid::Span;
use accel::{Counters, Nearest, Ray};
use lanes::packet::rows;
use lanes::{PackedObjects, ROW, Simd, Task, next_lane};

impl<O: PackedObjects> General<O> {
    /// Takes the beams of one octant through all that they meet.
    #[inline(always)]
    pub(super) fn drain_beams<S: Simd, const ANY: bool>(
        &self,
        s: S,
        negative: &[bool; 3],
        ready: &Ready,
        top: u32,
        scratch: &mut Scratch,
    ) {
        let Scratch { beams, beam_rays, lists, stack, spans, best, masks, steps, .. } = scratch;
        let (first, len) = (ready.first_beam, ready.beams);
        stack.push(Waiting { what: 0, first, len, top });
        while let Some(at) = stack.pop() {
            if at.what & Node::BLOCK == 0 {
                steps.cells += u64::from(at.len);
                let node = &self.nodes[at.what as usize];
                s.apart(Visit::<_, false> { node, negative, at, ways: beams, lists, stack });
                self.prefetch_next(stack);
            } else {
                steps.blocks += u64::from(at.len);
                let block = (at.what & !Node::BLOCK) as usize;
                let ids = &lists[at.first as usize..(at.first + at.len) as usize];
                let (maps, boxes) = (&self.maps[block], self.boxes.get(block));
                s.apart(Within { maps, boxes, beams, ids, masks });
                for (id, candidates) in ids.iter().zip(&*masks) {
                    if *candidates != 0 {
                        let (beam, rays) = (&mut beams[usize::from(*id)], &mut beam_rays[usize::from(*id)]);
                        self.meet::<S, ANY>(s, (block, *candidates), beam, rays, spans, steps);
                    }
                }
            }
        }
        for id in &lists[first as usize..(first + len) as usize] {
            let (beam, rays) = (&beams[usize::from(*id)], &mut beam_rays[usize::from(*id)]);
            self.end::<S, ANY>(s, rays, &mut best[beam.first as usize..]);
        }
    }

    /// Takes over what was found for a beam's rays.
    #[inline(always)]
    fn end<S: Simd, const ANY: bool>(&self, s: S, rays: &BeamRays, best: &mut [Nearest]) {
        let nearest = s.apart(ResolveBeam { objects: &self.objects, rays, any: ANY });
        for (best, nearest) in best.iter_mut().zip(&nearest) {
            if nearest.object != Nearest::NONE {
                *best = *nearest;
            }
        }
    }

    /// Tests all rays with all objects, which are in one block.
    #[inline(always)]
    pub(super) fn test_all<S: Simd, const ANY: bool>(&self, s: S, rays: &[Ray], scratch: &mut Scratch) {
        let Scratch { best, steps, .. } = scratch;
        best.clear();
        best.resize(rays.len(), Nearest::new(0.0));
        let (objects, candidates) = (&self.objects, (1 << self.len) - 1);
        for (rays, best) in rays.chunks(ROW).zip(best.chunks_mut(ROW)) {
            let mut rays = BeamRays::new(rows(s, rays), u32::MAX >> (32 - rays.len()));
            let test = TestBeam { objects, block: 0, candidates, rays: &mut rays, any: ANY };
            steps.tests += s.apart(test).tests;
            self.end::<S, ANY>(s, &rays, best);
        }
    }

    /// Tests the rays of a beam with the candidates of a block.
    #[inline(always)]
    fn meet<S: Simd, const ANY: bool>(
        &self,
        s: S,
        (block, candidates): (usize, u64),
        beam: &mut Beam,
        rays: &mut BeamRays,
        spans: &[Span],
        steps: &mut Counters,
    ) {
        let objects = &self.objects;
        let Tested { mut on, tests } =
            s.apart(TestBeam { objects, block, candidates, rays: &mut *rays, any: ANY });
        steps.candidates += u64::from(candidates.count_ones());
        steps.tests += tests;
        if ANY {
            if on == 0 {
                beam.near.start[3] = TraversalState::DONE;
            }
            return;
        }
        // What a ray's nearest hit allows; where there is none yet, all.
        let mut limit = TraversalState::DONE;
        while let Some(lane) = next_lane(&mut on) {
            let here = if rays.object[lane] == Nearest::NONE {
                LIMIT
            } else {
                spans[beam.first as usize + lane].limit(rays.t[lane])
            };
            limit = limit.max(here);
        }
        beam.near.start[3] = limit;
    }
}

/// The candidates of beams in a block; none of those that are done.
struct Within<'a> {
    maps: &'a BlockMaps,
    boxes: Option<&'a BlockBoxes>,
    beams: &'a [Beam],
    /// The beams, by number.
    ids: &'a [u16],
    masks: &'a mut Vec<u64>,
}

impl Task for Within<'_> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let Self { maps, boxes, beams, ids, masks } = self;
        masks.clear();
        for id in ids {
            let beam = &beams[usize::from(*id)];
            let done = beam.near.start[3] < 0.0;
            let candidates = if done { 0 } else { beam.candidates(s, maps) };
            masks.push(match boxes {
                Some(boxes) => boxes.met_by(s, maps, [&beam.near, &beam.far], candidates),
                None => candidates,
            });
        }
    }
}
