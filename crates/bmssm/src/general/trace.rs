//! The way of one ray through the levels.

use super::General;
use super::tree::{Node, WIDTH};
use accel::grid::Segment;
use accel::objects::{Blocks, Objects};
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
#[derive(Clone, Copy, Debug)]
struct Waiting {
    enter: f32,
    exit: f32,
    /// As in [`Node::children`].
    what: u32,
}

/// What waits to be visited, the nearest on top; kept from ray to ray.
#[derive(Default)]
pub(super) struct Stack(Vec<Waiting>);

impl Stack {
    /// Puts an entry among those from `base` on, which stay sorted.
    #[inline(always)]
    fn insert(&mut self, base: usize, entry: Waiting) {
        self.0.push(entry);
        let tail = &mut self.0[base..];
        let mut place = tail.len() - 1;
        while place > 0 && tail[place - 1].enter < entry.enter {
            tail[place] = tail[place - 1];
            place -= 1;
        }
        tail[place] = entry;
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
        if self.nodes.is_empty() {
            return best;
        }
        let way = Way::new(&segment);
        let prepared = self.objects.one(ray);
        let mut limit = 1.0 + 4.0 * accel::grid::MARGIN as f32;
        stack.0.clear();
        stack.0.push(Waiting { enter: 0.0, exit: 1.0, what: 0 });
        while let Some(Waiting { enter, exit, what }) = stack.0.pop() {
            if enter > limit {
                continue;
            }
            let exit = if exit < limit { exit } else { limit };
            if what & Node::BLOCK != 0 {
                let block = (what & !Node::BLOCK) as usize;
                count.blocks(1);
                let candidates = self.maps[block].candidates(s, way.at(enter), way.at(exit));
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
                count.cells(1);
                push(s, &self.nodes[what as usize], &way, limit, stack);
            }
        }
        best
    }
}

/// Puts the children whose boxes the ray meets on the stack, the nearest on top.
#[inline(always)]
fn push<S: Simd>(s: S, node: &Node, way: &Way, limit: f32, stack: &mut Stack) {
    let base = stack.0.len();
    for at in (0..WIDTH).step_by(S::LANES) {
        let mut enter = s.splat(0.0);
        let mut exit = s.splat(limit);
        for axis in 0..3 {
            let (start, inverse) = (s.splat(way.start[axis]), s.splat(way.inverse[axis]));
            let (near, far) = if way.delta[axis] >= 0.0 { (axis, axis + 3) } else { (axis + 3, axis) };
            enter = s.max(enter, s.mul(s.sub(s.load(&node.boxes[near].0[at..]), start), inverse));
            exit = s.min(exit, s.mul(s.sub(s.load(&node.boxes[far].0[at..]), start), inverse));
        }
        let mut met = s.bits(s.le(enter, exit));
        if met == 0 {
            continue;
        }
        let (mut enters, mut exits) = ([0.0; ROW], [0.0; ROW]);
        s.store(enter, &mut enters);
        s.store(exit, &mut exits);
        while met != 0 {
            let lane = met.trailing_zeros() as usize & (ROW - 1);
            met &= met - 1;
            let what = node.children[(at + lane) & (WIDTH - 1)];
            stack.insert(base, Waiting { enter: enters[lane], exit: exits[lane], what });
        }
    }
}
