//! Many rays through the levels together: each node sorts the rays that reach it to its children, so that its boxes are
//! read once for all of them and no ray waits for itself (R. Barringer, T. Akenine-Möller, *Dynamic Ray Stream Traversal*, ACM
//! Transactions on Graphics 33(4), 2014).
//!
//! What the objects have no part in is done in tasks apart, so that it is compiled once and not for each kind of them.

use super::General;
use super::paths::Along;
use super::ready::{Begin, Begun, MIXED};
use super::scratch::{Scratch, Waiting};
use super::state::TraversalState;
use super::test::{ResolveEach, TestOne, TestPairs};
use super::tree::Node;
use super::visit::Visit;
use accel::Ray;
use lanes::{Blocks, PackedObjects, ROW, Simd, next_lane, prefetch};

/// From this many blocks on, rays that begin within the scene in many directions are listed together: over fewer, lists by octant
/// fill as well, and visits that know their octant are shorter.
const MIXED_BLOCKS: usize = 1200;

/// So many objects in one block are tested with every ray, sooner than rays are prepared for anything else.
const FEW: usize = 8;

/// A ray prepared for the objects in blocks `B`.
type One<O> = <<O as PackedObjects>::Blocks as Blocks>::One;

impl<O: PackedObjects> General<O> {
    /// The nearest hits of up to [`STREAM`] rays, or for `ANY` some hit, left in `scratch.best`.
    #[inline(always)]
    pub(super) fn stream<S: Simd, const ANY: bool>(&self, s: S, rays: &[Ray], scratch: &mut Scratch) {
        if self.len <= FEW && self.maps.len() <= 1 {
            return self.test_all::<S, ANY>(s, rays, scratch);
        }
        let pairs = O::Blocks::takes_pairs::<S>();
        let mut ones = Vec::new();
        if !pairs {
            ones.extend(rays.iter().map(|ray| self.objects.one(ray)));
        }
        let mixed = self.maps.len() >= MIXED_BLOCKS;
        let Begun { ready, top } =
            s.apart(Begin { frame: &self.frame, spread: self.spread, mixed, rays, scratch: &mut *scratch });
        for (group, ready) in ready.iter().enumerate() {
            let negative = [group & 1 != 0, group & 2 != 0, group & 4 != 0];
            if ready.len > 0 {
                scratch.stack.push(Waiting { what: 0, first: ready.first, len: ready.len, top });
                let negative = (group != MIXED).then_some(&negative);
                self.drain::<S, ANY>(s, negative, rays, &ones, scratch);
            }
            if ready.beams > 0 {
                self.drain_beams::<S, ANY>(s, &negative, ready, top, scratch);
            }
        }
        if ANY {
            // That something is hit needs no t.
        } else if pairs {
            let best = &mut scratch.best[..rays.len()];
            s.apart(ResolveEach { objects: &self.objects, rays, best });
        } else {
            for (one, best) in ones.iter().zip(&mut scratch.best) {
                self.objects.resolve(one, best);
            }
        }
    }

    /// Takes rays of one group through all that they meet. `negative` tells which coordinates of their directions are negative,
    /// unless they are mixed.
    #[inline(always)]
    fn drain<S: Simd, const ANY: bool>(
        &self,
        s: S,
        negative: Option<&[bool; 3]>,
        rays: &[Ray],
        ones: &[One<O>],
        scratch: &mut Scratch,
    ) {
        while let Some(at) = scratch.stack.pop() {
            if at.what & Node::BLOCK == 0 {
                let Scratch { states, lists, stack, steps, .. } = &mut *scratch;
                steps.cells += u64::from(at.len);
                let node = &self.nodes[at.what as usize];
                let (ways, here) = (&*states, negative.unwrap_or(&[false; 3]));
                if negative.is_none() {
                    s.apart(Visit::<_, true> { node, negative: here, at, ways, lists, stack });
                } else {
                    s.apart(Visit::<_, false> { node, negative: here, at, ways, lists, stack });
                }
                self.prefetch_next(stack);
            } else {
                scratch.steps.blocks += u64::from(at.len);
                self.objects.prefetch((at.what & !Node::BLOCK) as usize);
                self.block::<S, ANY>(s, at, rays, ones, scratch);
            }
        }
    }

    /// Asks for the memory of what is soon to be visited.
    #[inline(always)]
    pub(super) fn prefetch_next(&self, stack: &[Waiting]) {
        for Waiting { what, .. } in stack.iter().rev().take(2) {
            if what & Node::BLOCK == 0 {
                prefetch(&self.nodes[*what as usize]);
            } else {
                prefetch(&self.maps[(what & !Node::BLOCK) as usize]);
            }
        }
    }

    /// Tests rays with the objects of a block.
    #[inline(always)]
    fn block<S: Simd, const ANY: bool>(
        &self,
        s: S,
        at: Waiting,
        rays: &[Ray],
        ones: &[One<O>],
        scratch: &mut Scratch,
    ) {
        let block = (at.what & !Node::BLOCK) as usize;
        let (maps, boxes) = (&self.maps[block], self.boxes.get(block));
        let Scratch { states, spans, best, lists, pairs, steps, .. } = scratch;
        let list = &lists[at.first as usize..(at.first + at.len) as usize];
        for ids in list.chunks(S::LANES) {
            let (mut limits, mut changed) = ([TraversalState::DONE; ROW], 0u32);
            if O::Blocks::takes_pairs::<S>() {
                pairs.len = 0;
                s.apart(Along { maps, boxes, states, ids, pairs: Some(&mut *pairs) });
                steps.candidates += pairs.len as u64;
                steps.tests += pairs.len as u64;
                if pairs.len == 0 {
                    continue;
                }
                let (objects, pairs) = (&self.objects, &*pairs);
                let nearest = s.apart(TestPairs { objects, block, rays, best, ids, pairs, any: ANY });
                for (lane, (nearest, id)) in nearest.iter().zip(ids).enumerate() {
                    let id = usize::from(*id);
                    if nearest.object != best[id].object || nearest.t != best[id].t {
                        best[id] = *nearest;
                        limits[lane] = if ANY { TraversalState::DONE } else { spans[id].limit(nearest.t) };
                        changed |= 1 << lane;
                    }
                }
            } else {
                let masks = s.apart(Along { maps, boxes, states, ids, pairs: None });
                for (lane, (candidates, id)) in masks.into_iter().zip(ids).enumerate() {
                    if candidates == 0 {
                        continue;
                    }
                    steps.candidates += u64::from(candidates.count_ones());
                    steps.tests += u64::from(candidates.count_ones());
                    let id = usize::from(*id);
                    let (objects, one, best) = (&self.objects, &ones[id], &mut best[id]);
                    let test = TestOne { objects, block, candidates, one, best: &mut *best, any: ANY };
                    if s.apart(test) {
                        limits[lane] = if ANY { TraversalState::DONE } else { spans[id].limit(best.t) };
                        changed |= 1 << lane;
                    }
                }
            }
            while let Some(lane) = next_lane(&mut changed) {
                states[usize::from(ids[lane])].start[3] = limits[lane];
            }
        }
    }
}
