//! Neighbouring rays taken through the levels as one (A. Reshetov, A. Soupikov, J. Hurley, *Multi-Level Ray Tracing Algorithm*, ACM
//! Transactions on Graphics 24(3), 2005; intervals in place of frusta).

use super::maps::BlockMaps;
use super::state::{DirectionRows, LIMIT, NodeView, TraversalState};
use accel::Nearest;
use accel::grid::{RayRows, SegmentRows};
use lanes::packet::{NearestPacket, Packet};
use lanes::path::{Hull, dominant_axis};
use lanes::{ROW, Simd};

/// By how much hulls are widened: 16 times the rounding of a position, of which there are a few.
const WIDER: f32 = 1.0 / (1 << 20) as f32;

/// Up to 16 neighbouring rays of one octant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    /// A ray that enters each box no later than any of them, and what they share: the place up to which objects must be looked at.
    pub near: TraversalState,
    /// A ray that leaves each box no sooner than any of them.
    pub far: TraversalState,
    /// What contains them all.
    hull: UnitHull,
    /// That of its rays.
    pub octant: usize,
    /// The number of the first ray.
    pub first: u32,
}

/// What contains a beam's rays, in unit coordinates.
#[derive(Clone, Copy, Debug)]
struct UnitHull {
    /// The axis along which it is described, to which no ray is at a right angle.
    axis: usize,
    /// Where it begins and ends on that axis.
    range: [f32; 2],
    /// The least and the greatest coordinate on the two following axes, each at the begin and at the end.
    sides: [[[f32; 2]; 2]; 2],
}

/// The rays of a beam and their nearest hits, coordinate by coordinate.
#[derive(Clone, Debug)]
pub(super) struct BeamRays {
    pub rays: RayRows<ROW>,
    /// As in [`lanes::packet::NearestPacket`].
    pub t: [f32; ROW],
    pub object: [u32; ROW],
    pub u: [f32; ROW],
    pub v: [f32; ROW],
}

impl BeamRays {
    /// No hits yet of the rays `on`; the others are never tested.
    #[inline(always)]
    pub fn new(rays: RayRows<ROW>, on: u32) -> Self {
        let mut t = rays.t_max;
        for (lane, t) in t.iter_mut().enumerate() {
            *t = if on >> lane & 1 != 0 { *t } else { f32::NEG_INFINITY };
        }
        Self { rays, t, object: [Nearest::NONE; ROW], u: [0.0; ROW], v: [0.0; ROW] }
    }

    /// The rays from lane `at` on.
    #[inline(always)]
    pub fn packet<S: Simd>(&self, s: S, at: usize) -> Packet<S> {
        let RayRows { origin, direction, t_min, t_max } = &self.rays;
        let [x, y, z] = origin;
        let [dx, dy, dz] = direction;
        Packet {
            origin: [s.load(&x[at..]), s.load(&y[at..]), s.load(&z[at..])],
            direction: [s.load(&dx[at..]), s.load(&dy[at..]), s.load(&dz[at..])],
            t_min: s.load(&t_min[at..]),
            t_max: s.load(&t_max[at..]),
        }
    }

    /// Their nearest hits.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, s: S, at: usize) -> NearestPacket<S> {
        NearestPacket {
            t: s.load(&self.t[at..]),
            object: s.load_u(&self.object[at..]),
            u: s.load(&self.u[at..]),
            v: s.load(&self.v[at..]),
        }
    }

    /// Takes what was found.
    #[inline(always)]
    pub fn set<S: Simd>(&mut self, s: S, at: usize, nearest: &NearestPacket<S>) {
        s.store(nearest.t, &mut self.t[at..]);
        s.store_u(nearest.object, &mut self.object[at..]);
        s.store(nearest.u, &mut self.u[at..]);
        s.store(nearest.v, &mut self.v[at..]);
    }
}

impl NodeView for Beam {
    #[inline(always)]
    fn near(&self) -> &TraversalState {
        &self.near
    }
    #[inline(always)]
    fn far(&self) -> &TraversalState {
        &self.far
    }
}

impl Beam {
    /// The beam of the rays `on`, if they are of one octant and near enough to each other.
    #[inline(always)]
    pub fn of<S: Simd>(
        s: S,
        segments: &SegmentRows<ROW>,
        ways: &DirectionRows,
        on: u32,
        first: u32,
        spread: f32,
    ) -> Option<Self> {
        if on == 0 || !ways.agree(on) {
            return None;
        }
        let lane = on.trailing_zeros() as usize % ROW;
        let octant = ways.octant(lane) as usize;
        let (mut start, mut delta, mut size) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            (start[axis], delta[axis]) = (segments.start[axis][lane], segments.delta[axis][lane]);
            size[axis] = delta[axis].abs();
        }
        let axis = dominant_axis(size);
        let (spread, half) = (s.splat(spread), s.splat(0.5 * size[axis]));
        let mut straight = true;
        for at in (0..ROW).step_by(S::LANES) {
            for axis in 0..3 {
                let begin = s.sub(s.load(&segments.start[axis][at..]), s.splat(start[axis]));
                let way = s.sub(s.load(&segments.delta[axis][at..]), s.splat(delta[axis]));
                let close = s.bits(s.le(s.add(s.abs(begin), s.abs(way)), spread));
                if !close & (on >> at) & (u32::MAX >> (32 - S::LANES)) != 0 {
                    return None;
                }
            }
            let long = s.bits(s.lt(half, s.abs(s.load(&segments.delta[axis][at..]))));
            straight &= !long & (on >> at) & (u32::MAX >> (32 - S::LANES)) == 0;
        }
        let (mut near, mut far) = (TraversalState::NONE, TraversalState::NONE);
        near.start[3] = LIMIT;
        far.start[3] = LIMIT;
        let mut range = Range::NONE;
        for (axis, start) in start.into_iter().enumerate() {
            let (mut starts, mut inverses) = (Range::NONE, Range::NONE);
            for at in (0..ROW).step_by(S::LANES) {
                let on = s.mask(on >> at);
                let begin = s.select(on, s.load(&segments.start[axis][at..]), s.splat(start));
                let inverse =
                    s.select(on, s.load(&ways.inverse[axis][at..]), s.splat(ways.inverse[axis][lane]));
                starts.gather(s, begin);
                inverses.gather(s, inverse);
            }
            let negative = octant >> axis & 1 != 0;
            let ([least, most], [slow, fast]) = (starts.0, inverses.0);
            (near.start[axis], far.start[axis]) = if negative { (least, most) } else { (most, least) };
            // The inverse that is nearest to zero makes entering earliest.
            (near.inverse[axis], far.inverse[axis]) = if negative { (fast, slow) } else { (slow, fast) };
        }
        for at in (0..ROW).step_by(S::LANES) {
            let on = s.mask(on >> at);
            let begin = s.select(on, s.load(&segments.start[axis][at..]), s.splat(start[axis]));
            let way = s.select(on, s.load(&segments.delta[axis][at..]), s.splat(delta[axis]));
            range.gather(s, begin);
            range.gather(s, s.add(begin, way));
        }
        let range = range.widened();
        let mut sides = [[[0.0; 2]; 2]; 2];
        for (side, other) in sides.iter_mut().zip([(axis + 1) % 3, (axis + 2) % 3]) {
            let mut ends = [Range::NONE; 2];
            for at in (0..ROW).step_by(S::LANES) {
                let on = s.mask(on >> at);
                let begin = s.select(on, s.load(&segments.start[axis][at..]), s.splat(start[axis]));
                let inverse =
                    s.select(on, s.load(&ways.inverse[axis][at..]), s.splat(ways.inverse[axis][lane]));
                let from = s.select(on, s.load(&segments.start[other][at..]), s.splat(start[other]));
                let way = s.select(on, s.load(&segments.delta[other][at..]), s.splat(delta[other]));
                if straight {
                    let slope = s.mul(way, inverse);
                    for (end, place) in ends.iter_mut().zip(range) {
                        end.gather(s, s.add(from, s.mul(s.sub(s.splat(place), begin), slope)));
                    }
                } else {
                    // A box, as rays so different in length may be far apart where they are extended.
                    for end in &mut ends {
                        end.gather(s, from);
                        end.gather(s, s.add(from, way));
                    }
                }
            }
            let ends = [ends[0].widened(), ends[1].widened()];
            *side = [[ends[0][0], ends[1][0]], [ends[0][1], ends[1][1]]];
        }
        Some(Self { near, far, hull: UnitHull { axis, range, sides }, first, octant })
    }

    /// What the rays' straight ways may meet in a block.
    #[inline(always)]
    pub fn candidates<S: Simd>(&self, s: S, maps: &BlockMaps) -> u64 {
        let UnitHull { axis, range, sides } = &self.hull;
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let [low, high] = maps.local_pair(*axis, *range);
        let per_slice = 1.0 / (high - low);
        let mut lines = [[[0.0; 2]; 2]; 2];
        for (lines, (side, other)) in lines.iter_mut().zip(sides.iter().zip([b, c])) {
            for (line, ends) in lines.iter_mut().zip(side) {
                let [begin, end] = maps.local_pair(other, *ends);
                *line = [begin, (end - begin) * per_slice];
            }
        }
        maps.within(s, *axis, &Hull { low, high, sides: lines })
    }
}

/// The least and the greatest of some numbers.
#[derive(Clone, Copy)]
struct Range([f32; 2]);

impl Range {
    const NONE: Self = Self([f32::INFINITY, f32::NEG_INFINITY]);

    #[inline(always)]
    fn gather<S: Simd>(&mut self, s: S, lanes: S::F) {
        let [least, most] = self.0;
        self.0 = [least.min(s.least(lanes)), most.max(s.most(lanes))];
    }

    #[inline(always)]
    fn widened(&self) -> [f32; 2] {
        [self.0[0] - WIDER, self.0[1] + WIDER]
    }
}
