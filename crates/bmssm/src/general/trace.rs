//! The way of one ray through the levels.

mod all;

use super::General;
use super::state::{MIN, TraversalState};
use super::tree::{Node, WIDTH};
use accel::grid::Segment;
use accel::tolerance::LIMIT_S;
use accel::{Nearest, Ray};
use lanes::{Blocks, PackedObjects, ROW, Simd, next_lane};

/// A ray in the unit coordinates of the scene, as `start + s·delta` with s from 0 to 1.
#[derive(Clone, Copy, Debug)]
struct ClippedSegment {
    start: [f32; 3],
    delta: [f32; 3],
    inverse: [f32; 3],
}

impl ClippedSegment {
    #[inline(always)]
    fn new(segment: &Segment) -> Self {
        let [x, y, z] = segment.delta.to_array();
        let delta = [at_least(x), at_least(y), at_least(z)];
        let inverse = [1.0 / delta[0], 1.0 / delta[1], 1.0 / delta[2]];
        Self { start: segment.start.to_array(), delta, inverse }
    }

    /// As blocks need it, with the place up to which objects must be looked at.
    #[inline(always)]
    fn state(&self, limit: f32) -> TraversalState {
        let ([x, y, z], [dx, dy, dz]) = (self.start, self.inverse);
        TraversalState { start: [x, y, z, limit], inverse: [dx, dy, dz, limit] }
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
    if component.abs() < MIN { MIN.copysign(component) } else { component }
}

/// A child that waits: where the ray enters and leaves its box, and which it is.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    enter: f32,
    exit: f32,
    /// As in [`Node::children`].
    what: u32,
}

impl Waiting {
    const NONE: Self = Self { enter: 0.0, exit: 0.0, what: 0 };
}

/// What waits to be visited, the nearest on top; kept from ray to ray.
pub(super) struct Stack {
    slots: Vec<Waiting>,
    len: usize,
}

impl Default for Stack {
    fn default() -> Self {
        Self { slots: vec![Waiting::NONE; 16 * WIDTH], len: 0 }
    }
}

impl Stack {
    /// Room on top for the children of a node.
    #[inline(always)]
    fn room(&mut self) -> &mut [Waiting; WIDTH] {
        if self.slots.len() < self.len + WIDTH {
            self.grow();
        }
        self.slots[self.len..].first_chunk_mut().expect("room was made")
    }

    #[cold]
    fn grow(&mut self) {
        self.slots.resize(2 * self.slots.len(), Waiting::NONE);
    }

    /// The next that begins no later than `limit`.
    #[inline(always)]
    fn pop(&mut self, limit: f32) -> Option<Waiting> {
        while self.len > 0 {
            self.len -= 1;
            let next = self.slots[self.len];
            if next.enter <= limit {
                return Some(next);
            }
        }
        None
    }
}

impl<O: PackedObjects> General<O> {
    /// The nearest hit, or for `ANY` some hit.
    #[inline(always)]
    pub(super) fn nearest<S: Simd, const ANY: bool>(&self, s: S, ray: &Ray, stack: &mut Stack) -> Nearest {
        let mut best = Nearest::new(ray.t_max);
        let Some(segment) = self.frame.clip(ray) else {
            return best;
        };
        if self.nodes.is_empty() {
            return best;
        }
        let clipped = ClippedSegment::new(&segment);
        let prepared = self.objects.one(ray);
        let mut limit = 1.0 + LIMIT_S as f32;
        stack.len = 0;
        let mut next = Some(Waiting { enter: 0.0, exit: 1.0, what: 0 });
        while let Some(Waiting { enter, exit, what }) = next {
            if what & Node::BLOCK == 0 {
                next = match nearest_child(s, &self.nodes[what as usize], &clipped, limit, stack) {
                    None => stack.pop(limit),
                    child => child,
                };
                continue;
            }
            let exit = if exit < limit { exit } else { limit };
            let block = (what & !Node::BLOCK) as usize;
            let maps = &self.maps[block];
            let mut candidates = maps.candidates(s, clipped.at(enter), clipped.at(exit));
            if let Some(boxes) = self.boxes.get(block) {
                candidates = boxes.met_by(s, maps, [&clipped.state(limit); 2], candidates);
            }
            if candidates != 0 {
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
            }
            next = stack.pop(limit);
        }
        self.objects.resolve(&prepared, &mut best);
        best
    }
}

/// The nearest child whose box the ray meets; the others go on the stack, the nearest on top.
#[inline(always)]
fn nearest_child<S: Simd>(
    s: S,
    node: &Node,
    clipped: &ClippedSegment,
    limit: f32,
    stack: &mut Stack,
) -> Option<Waiting> {
    let (mut enters, mut exits) = ([0.0; ROW], [0.0; ROW]);
    let mut met = 0;
    for at in (0..WIDTH).step_by(S::LANES) {
        let mut enter = s.splat(0.0);
        let mut exit = s.splat(limit);
        for axis in 0..3 {
            let (start, inverse) = (s.splat(clipped.start[axis]), s.splat(clipped.inverse[axis]));
            let (near, far) = if clipped.delta[axis] >= 0.0 { (axis, axis + 3) } else { (axis + 3, axis) };
            enter = s.max(enter, s.mul(s.sub(s.load(&node.boxes[near].0[at..]), start), inverse));
            exit = s.min(exit, s.mul(s.sub(s.load(&node.boxes[far].0[at..]), start), inverse));
        }
        met |= s.bits(s.le(enter, exit)) << at;
        s.store(enter, &mut enters[at..]);
        s.store(exit, &mut exits[at..]);
    }
    let child = |lane: usize| Waiting { enter: enters[lane], exit: exits[lane], what: node.children[lane] };
    let mut nearest = child(next_lane(&mut met)?);
    if met == 0 {
        return Some(nearest);
    }
    // The farthest first; what comes nearer than all so far takes the place of the nearest.
    let room = stack.room();
    let mut len = 0;
    while let Some(lane) = next_lane(&mut met) {
        let mut other = child(lane);
        if other.enter < nearest.enter {
            (other, nearest) = (nearest, other);
        }
        let mut place = len & (WIDTH - 1);
        while place > 0 && room[place - 1].enter < other.enter {
            room[place] = room[place - 1];
            place -= 1;
        }
        room[place] = other;
        len += 1;
    }
    stack.len += len;
    Some(nearest)
}
