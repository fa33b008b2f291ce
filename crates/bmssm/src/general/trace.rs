//! The way of one ray through the levels.

use super::General;
use super::tree::Node;
use accel::grid::Segment;
use accel::objects::{BLOCK, Blocks, Objects};
use accel::simd::{ROW, Simd};
use accel::{Count, Nearest, Ray};

/// A component of the way is at least this long, which is less than the margin of registration: so its
/// reciprocal is finite and no product is NaN.
const LEAST: f32 = 1.0 / (1 << 23) as f32;

/// A ray in the unit coordinates of the scene, as `start + s·delta` with s from 0 to 1.
#[derive(Clone, Copy, Debug)]
struct Way {
    start: [f32; 3],
    delta: [f32; 3],
    inverse: [f32; 3],
}

impl Way {
    #[inline(always)]
    fn new(segment: &Segment) -> Self {
        let [x, y, z] = segment.delta.to_array();
        let delta = [at_least(x), at_least(y), at_least(z)];
        let inverse = [1.0 / delta[0], 1.0 / delta[1], 1.0 / delta[2]];
        Self { start: segment.start.to_array(), delta, inverse }
    }

    #[inline(always)]
    fn at(&self, s: f32) -> [f32; 3] {
        [
            self.start[0] + s * self.delta[0],
            self.start[1] + s * self.delta[1],
            self.start[2] + s * self.delta[2],
        ]
    }
}

#[inline(always)]
fn at_least(component: f32) -> f32 {
    if component.abs() < LEAST { LEAST.copysign(component) } else { component }
}

/// A child that waits: where the ray enters and leaves its box, and which it is.
#[derive(Clone, Copy, Debug, Default)]
struct Waiting {
    enter: f32,
    exit: f32,
    /// A node's index, or a block's with [`IS_BLOCK`] set.
    what: u32,
}

const IS_BLOCK: u32 = 1 << 31;

/// Enough for 64 children on each of more levels than 2³² objects have.
const DEPTH: usize = 64 * 8;

/// What waits to be visited, the nearest on top; kept from ray to ray.
pub(super) struct Stack {
    entries: [Waiting; DEPTH],
    len: usize,
}

impl Default for Stack {
    fn default() -> Self {
        Self { entries: [Waiting::default(); DEPTH], len: 0 }
    }
}

impl Stack {
    #[inline(always)]
    fn pop(&mut self) -> Option<Waiting> {
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len])
    }

    /// Puts an entry among those from `base` on, which stay sorted.
    #[inline(always)]
    fn insert(&mut self, base: usize, entry: Waiting) {
        let mut place = self.len;
        while place > base && self.entries[place - 1].enter < entry.enter {
            self.entries[place] = self.entries[place - 1];
            place -= 1;
        }
        self.entries[place] = entry;
        self.len += 1;
    }
}

impl<O: Objects> General<O> {
    /// The nearest hit, or for `ANY` some hit.
    #[inline(always)]
    pub(super) fn nearest<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        ray: &Ray,
        stack: &mut Stack,
        count: &mut C,
    ) -> Nearest {
        let mut best = Nearest::new(ray.t_max);
        let Some(segment) = self.frame.clip(ray) else {
            return best;
        };
        if self.tree.nodes.is_empty() {
            return best;
        }
        let way = Way::new(&segment);
        let prepared = self.objects.one(ray);
        let mut limit = 1.0 + 4.0 * accel::grid::MARGIN as f32;
        stack.len = 0;
        stack.insert(0, Waiting { enter: 0.0, exit: 1.0, what: 0 });
        while let Some(Waiting { enter, exit, what }) = stack.pop() {
            if enter > limit {
                continue;
            }
            let exit = if exit < limit { exit } else { limit };
            let (from, to) = (way.at(enter), way.at(exit));
            if what & IS_BLOCK != 0 {
                let block = (what & !IS_BLOCK) as usize;
                count.blocks(1);
                let candidates = self.maps[block].candidates(s, from, to);
                count.candidates(u64::from(candidates.count_ones()));
                if candidates == 0 {
                    continue;
                }
                count.tests(u64::from(candidates.count_ones()));
                if ANY {
                    if self.objects.any(s, block, candidates, &prepared, ray.t_max) {
                        best.object = 0;
                        return best;
                    }
                } else {
                    let before = best.t;
                    self.objects.closest(s, block, candidates, &prepared, &mut best);
                    if best.t < before {
                        limit = segment.limit(best.t);
                    }
                }
            } else {
                let node = &self.tree.nodes[what as usize];
                count.cells(1);
                let candidates = node.maps.candidates(s, from, to);
                self.push(s, node, candidates, &way, limit, stack);
            }
        }
        best
    }

    /// Tests the boxes of the candidates and puts those that the ray meets on the stack, the nearest on top.
    #[inline(always)]
    fn push<S: Simd>(
        &self,
        s: S,
        node: &Node,
        mut candidates: u64,
        way: &Way,
        limit: f32,
        stack: &mut Stack,
    ) {
        let lanes_mask = u64::MAX >> (64 - S::LANES);
        let base = stack.len;
        while candidates != 0 {
            let first = candidates.trailing_zeros() as usize / S::LANES * S::LANES;
            let wanted = (candidates >> first & lanes_mask) as u32;
            candidates &= !(lanes_mask << first);
            let group = &self.tree.boxes[node.boxes as usize + first / ROW];
            let at = first % ROW;
            let mut enter = s.splat(0.0);
            let mut exit = s.splat(limit);
            for axis in 0..3 {
                let (start, inverse) = (s.splat(way.start[axis]), s.splat(way.inverse[axis]));
                let (near, far) = if way.delta[axis] >= 0.0 { (axis, axis + 3) } else { (axis + 3, axis) };
                enter = s.max(enter, s.mul(s.sub(s.load(&group[near].0[at..]), start), inverse));
                exit = s.min(exit, s.mul(s.sub(s.load(&group[far].0[at..]), start), inverse));
            }
            let mut met = s.bits(s.le(enter, exit)) & wanted;
            if met == 0 {
                continue;
            }
            let (mut enters, mut exits) = ([0.0; ROW], [0.0; ROW]);
            s.store(enter, &mut enters);
            s.store(exit, &mut exits);
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                let child = (first + lane) as u32;
                let what = if child < node.blocks {
                    IS_BLOCK | (node.first_block + child)
                } else {
                    node.first_node + child - node.blocks
                };
                stack.insert(base, Waiting { enter: enters[lane], exit: exits[lane], what });
            }
        }
    }
}

const _: () = assert!(BLOCK == 64);
