//! Neighbouring rays taken through the cells as one (I. Wald, T. Ize, A. Kensler, A. Knoll, S. Parker, *Ray Tracing Animated Scenes
//! Using Coherent Grid Traversal*, ACM Transactions on Graphics 25(3), 2006): slice by slice, all cells between straight lines that
//! contain the rays.

use super::brick::{BRICK, EDGE, SHIFT, cell_of};
use super::bricks::{BrickGrid, MAX_LEVELS};
use super::segment::{SegmentRows, cell_at};
use lanes::path::{dominant_axis, following};
use lanes::{ROW, Simd, next_bit};

/// By how much of the grid what contains the rays is widened: 16 times the rounding of a position, of which there are a few.
const WIDER: f32 = 1.0 / (1 << 20) as f32;

/// How far from the first of them the others begin and end at most, in cells of the grid.
const SPREAD: f32 = 2.0;

/// Most that a ray of a beam goes along another axis for its way along the first.
const STEEP: f32 = 2.0;

/// Fewer rays than this go by themselves.
const FEWEST: u32 = 4;

/// What contains some rays, in the finest cells.
#[derive(Debug)]
pub(super) struct Beam {
    /// The lanes of the rays.
    pub lanes: u32,
    /// The axis along which it is described, and the two others.
    axes: [usize; 3],
    /// Whether it goes towards lower slices.
    backward: bool,
    /// Where it begins and ends on that axis.
    range: [f32; 2],
    /// The least and the greatest coordinate on each of the other axes where the first axis is 0, and their change from there on.
    sides: [[[f32; 2]; 2]; 2],
}

/// What is done at the cells of a beam.
pub(super) trait VisitBeam {
    /// Looks at a cell that holds references; `false` to end the walk. Must be `#[inline(always)]`.
    fn cell(&mut self, number: usize) -> bool;
    /// The brick that the divided cell `number` holds.
    fn brick(&self, number: usize) -> u32;
}

impl Beam {
    /// Of the rays in these lanes those that are near to the first of them, if they are enough.
    #[inline(always)]
    pub fn of<S: Simd>(s: S, grid: &BrickGrid, rows: &SegmentRows, lanes: u32) -> Option<Self> {
        if lanes.count_ones() < FEWEST {
            return None;
        }
        let first = lanes.trailing_zeros() as usize % ROW;
        let delta = [0, 1, 2].map(|axis: usize| rows.delta[axis][first]);
        let size = delta.map(f32::abs);
        let axis = dominant_axis(size);
        let [b, c] = following(axis);
        let axes = [axis, b, c];
        let most = grid.finest_slices().into_iter().fold(1, u32::max);
        let wider = most as f32 * WIDER;
        // Shorter ones have no direction that is certain.
        if size[axis] <= wider {
            return None;
        }
        let spread = s.splat(SPREAD * (1u32 << grid.top()) as f32);
        let half = s.splat(0.5 * size[axis]);
        let mut near = 0;
        for at in (0..ROW).step_by(S::LANES) {
            let mut here = s.mask(lanes >> at);
            for axis in 0..3 {
                let (start, delta) = (rows.start[axis][first], delta[axis]);
                let from = s.sub(s.load(&rows.start[axis][at..]), s.splat(start));
                let way = s.sub(s.load(&rows.delta[axis][at..]), s.splat(delta));
                let close = s.and(s.le(s.abs(from), spread), s.le(s.abs(s.add(from, way)), spread));
                here = s.and(here, close);
            }
            let sign = s.splat(if delta[axis] < 0.0 { -1.0 } else { 1.0 });
            let length = s.mul(sign, s.load(&rows.delta[axis][at..]));
            here = s.and(here, s.lt(half, length));
            // Where they go steeply along the axis, rounding does not grow from one end to the other.
            for other in [axes[1], axes[2]] {
                let across = s.abs(s.load(&rows.delta[other][at..]));
                here = s.and(here, s.le(across, s.mul(s.splat(STEEP), length)));
            }
            near |= s.bits(here) << at;
        }
        let near = near & lanes;
        if near.count_ones() < FEWEST {
            return None;
        }
        let mut range = Range::NONE;
        for at in (0..ROW).step_by(S::LANES) {
            let on = s.mask(near >> at);
            let from = s.load(&rows.start[axis][at..]);
            range.gather(s, on, from);
            range.gather(s, on, s.add(from, s.load(&rows.delta[axis][at..])));
        }
        let range = range.widened(wider);
        let length = range[1] - range[0];
        let mut sides = [[[0.0; 2]; 2]; 2];
        for (side, other) in sides.iter_mut().zip([axes[1], axes[2]]) {
            let mut ends = [Range::NONE; 2];
            for at in (0..ROW).step_by(S::LANES) {
                let on = s.mask(near >> at);
                let (from, begin) = (s.load(&rows.start[other][at..]), s.load(&rows.start[axis][at..]));
                let slope = s.div(s.load(&rows.delta[other][at..]), s.load(&rows.delta[axis][at..]));
                for (end, place) in ends.iter_mut().zip(range) {
                    let along = s.sub(s.splat(place), begin);
                    end.gather(s, on, s.add(from, s.mul(along, slope)));
                }
            }
            let [begin, end] = ends.map(|end| end.widened(wider));
            for (line, (begin, end)) in side.iter_mut().zip(begin.into_iter().zip(end)) {
                *line = [begin, (end - begin) / length];
            }
        }
        Some(Self { lanes: near, axes, backward: delta[axis] < 0.0, range, sides })
    }

    /// Visits the cells that hold anything between its sides.
    #[inline(always)]
    pub fn walk<V: VisitBeam>(&self, grid: &BrickGrid, visit: &mut V) {
        let shift = grid.top() + SHIFT;
        let [a, b, c] = self.axes;
        let [first, last] = self.range.map(|place| slice(place, shift).min(grid.bricks[a] - 1));
        for step in 0..=last - first {
            let at = if self.backward { last - step } else { first + step };
            let [bs, cs] = self.across(at, shift);
            let mut brick = [0; 3];
            brick[a] = at;
            for of_c in cs[0]..=cs[1].min(grid.bricks[c] - 1) {
                for of_b in bs[0]..=bs[1].min(grid.bricks[b] - 1) {
                    (brick[b], brick[c]) = (of_b, of_c);
                    let node = grid.brick_at(brick);
                    if grid.occupied[node as usize] != 0 && !self.within(grid, node, brick, visit) {
                        return;
                    }
                }
            }
        }
    }

    /// Visits the cells of a brick of the grid; `false` where a visit ends the walk.
    #[inline(always)]
    fn within<V: VisitBeam>(&self, grid: &BrickGrid, node: u32, place: [u32; 3], visit: &mut V) -> bool {
        // The bricks within each other, and those of their cells that are still to be looked at.
        let mut path = [(node, place, self.cells(grid, node, place, grid.top())); MAX_LEVELS + 1];
        let mut depth = 0;
        loop {
            let (node, place, cells) = &mut path[depth];
            let Some(cell) = next_bit(cells) else {
                if depth == 0 {
                    return true;
                }
                depth -= 1;
                continue;
            };
            let number = *node as usize * BRICK + cell;
            if !grid.is_divided(*node, cell as u32) {
                if !visit.cell(number) {
                    return false;
                }
                continue;
            }
            let at = cell_of(*place, cell as u32);
            let brick = visit.brick(number);
            depth += 1;
            path[depth] = (brick, at, self.cells(grid, brick, at, grid.top() - SHIFT * depth as u32));
        }
    }

    /// The cells of 2^shift finest ones between its sides that hold anything, of a brick that is at `place` among those of its size.
    fn cells(&self, grid: &BrickGrid, node: u32, place: [u32; 3], shift: u32) -> u64 {
        let [a, b, c] = self.axes;
        let first = place.map(|at| at << SHIFT);
        let [start, end] = self.range.map(|at| slice(at, shift));
        let mut cells = 0;
        for at in first[a].max(start)..=(first[a] + EDGE - 1).min(end) {
            let [bs, cs] = self.across(at, shift);
            let row = run(bs, first[b], STRIDES[b]) * run(cs, first[c], STRIDES[c]);
            cells |= row << ((at - first[a]) * STRIDES[a]);
        }
        cells & grid.occupied[node as usize]
    }

    /// The first and the last slice of 2^shift cells on the other axes that it touches in a slice of the first axis.
    #[inline(always)]
    fn across(&self, at: u32, shift: u32) -> [[u32; 2]; 2] {
        let [low, high] = self.range;
        let near = low.max((at << shift) as f32);
        let far = high.min(((at + 1) << shift) as f32).max(near);
        let mut touched = [[0; 2]; 2];
        for (touched, [least, most]) in touched.iter_mut().zip(&self.sides) {
            let on = |line: &[f32; 2], place: f32| line[0] + (place - low) * line[1];
            let first = on(least, near).min(on(least, far));
            let last = on(most, near).max(on(most, far));
            *touched = [slice(first, shift), slice(last, shift)];
        }
        touched
    }
}

/// From a cell of a brick to the next along each axis.
const STRIDES: [u32; 3] = [1, EDGE, EDGE * EDGE];

/// The cells of a brick in these slices, the lowest of it being `first`, along an axis of that stride; none where there are none.
#[inline(always)]
fn run([least, most]: [u32; 2], first: u32, stride: u32) -> u64 {
    let low = least.max(first);
    let high = most.min(first + EDGE - 1);
    if low > high {
        return 0;
    }
    let all = 1u64 | 1 << stride | 1 << (2 * stride) | 1 << (3 * stride);
    (all & (u64::MAX >> (u64::BITS - stride * (high - low + 1)))) << (stride * (low - first))
}

/// The slice of 2^shift cells at a place.
#[inline(always)]
fn slice(place: f32, shift: u32) -> u32 {
    cell_at(place) >> shift
}

/// The least and the greatest of some numbers.
#[derive(Clone, Copy)]
struct Range([f32; 2]);

impl Range {
    const NONE: Self = Self([f32::INFINITY, f32::NEG_INFINITY]);

    #[inline(always)]
    fn gather<S: Simd>(&mut self, s: S, on: S::M, lanes: S::F) {
        let [least, most] = self.0;
        let low = s.select(on, lanes, s.splat(f32::INFINITY));
        let high = s.select(on, lanes, s.splat(f32::NEG_INFINITY));
        self.0 = [least.min(s.least(low)), most.max(s.most(high))];
    }

    #[inline(always)]
    fn widened(self, by: f32) -> [f32; 2] {
        [self.0[0] - by, self.0[1] + by]
    }
}
