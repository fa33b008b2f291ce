//! The walks of several rays side by side, each in a lane: a step of all of them takes hardly longer than a step of one, and what
//! the next step of one ray is costs no mispredicted jump.
//!
//! In loops over lanes without branches, which compilers turn into vectors.

use super::brick::{BRICK, EDGE, SHIFT, within};
use super::bricks::{BrickGrid, MAX_LEVELS};
use super::segment::{ClippedSegment, cell_at, greater, lesser, planes, slice_within};
use lanes::{ROW, Simd, next_lane};

/// A value for each lane.
pub(super) type Lanes<T> = [T; ROW];

/// What is done at the cells of several walks.
pub(super) trait VisitEach {
    /// Looks for each of the rays in `lanes` at a cell that holds references, and lessens up to which s others must be looked at
    /// for it. Must be `#[inline(always)]`.
    fn cells(&mut self, lanes: u32, numbers: &Lanes<u32>, limit: &mut Lanes<f32>);
    /// The brick that the divided cell `number` holds.
    fn brick(&self, number: usize) -> u32;
    /// Told of so many steps. Must be `#[inline(always)]`.
    fn steps(&mut self, count: u32);
}

/// Rays on their way through a grid.
pub(super) struct Walks {
    start: [Lanes<f32>; 3],
    delta: [Lanes<f32>; 3],
    scale: [Lanes<f32>; 3],
    offset: [Lanes<f32>; 3],
    step: [Lanes<u32>; 3],
    forward: [Lanes<u32>; 3],
    /// Where each is, in slices of 2^shift cells.
    slice: [Lanes<u32>; 3],
    /// Where it leaves them on each axis.
    planes: [Lanes<f32>; 3],
    /// From one plane to the next.
    between: [Lanes<f32>; 3],
    shift: Lanes<u32>,
    /// The brick it is in, and its cells that hold anything; none while it goes from brick to brick.
    node: Lanes<u32>,
    bits: Lanes<u64>,
    /// Its divided cells.
    divided: Lanes<u64>,
    /// The bricks that hold this one.
    parents: Lanes<[u32; MAX_LEVELS]>,
    /// Where it entered the cell it is in.
    enter: Lanes<f32>,
    /// Up to where it goes.
    limit: Lanes<f32>,
    /// The lanes that hold a ray.
    pub active: u32,
    /// Those of them that come to another brick of the grid: their slices are that brick's if their shift is a brick's, else
    /// cells of it.
    entering: u32,
}

impl Walks {
    /// No rays.
    pub const NONE: Self = {
        let (zero, none) = ([[0.0; ROW]; 3], [[0; ROW]; 3]);
        Self {
            start: zero,
            delta: zero,
            scale: zero,
            offset: zero,
            step: none,
            forward: none,
            slice: none,
            planes: zero,
            between: zero,
            shift: [0; ROW],
            node: [0; ROW],
            bits: [0; ROW],
            divided: [0; ROW],
            parents: [[0; MAX_LEVELS]; ROW],
            enter: [0.0; ROW],
            limit: [0.0; ROW],
            active: 0,
            entering: 0,
        }
    };

    /// Puts a ray at its beginning, to go up to s = `limit`, at most 1.
    #[inline(always)]
    pub fn begin(&mut self, grid: &BrickGrid, lane: usize, segment: &ClippedSegment, limit: f32) {
        let edge = grid.top() + SHIFT;
        let cell = segment.cell(0.0);
        for (axis, cell) in cell.into_iter().enumerate() {
            self.start[axis][lane] = segment.start[axis];
            self.delta[axis][lane] = segment.delta[axis];
            self.scale[axis][lane] = segment.scale[axis];
            self.offset[axis][lane] = segment.offset[axis];
            self.step[axis][lane] = segment.step[axis];
            self.forward[axis][lane] = segment.forward[axis];
            self.slice[axis][lane] = cell >> edge;
        }
        self.shift[lane] = edge;
        self.enter[lane] = 0.0;
        self.limit[lane] = limit;
        self.active |= 1 << lane;
        self.entering |= 1 << lane;
    }

    /// Lets each ray go a step, and look at the cell that it leaves if that holds anything.
    #[inline(always)]
    pub fn step<S: Simd, V: VisitEach>(&mut self, s: S, grid: &BrickGrid, visit: &mut V) {
        if self.entering != 0 {
            let full = self.enter_bricks(grid);
            visit.steps(full.count_ones());
        }
        visit.steps(self.active.count_ones());
        let top = grid.top();
        let edge = top + SHIFT;
        let (cell, before) = (self.slice, self.enter);
        let (mut numbers, mut occupied, mut crossed) = ([0; ROW], [0; ROW], [0; ROW]);
        let mut divided = [0; ROW];
        for lane in 0..ROW {
            let [px, py, pz] = [self.planes[0][lane], self.planes[1][lane], self.planes[2][lane]];
            let exit = lesser(lesser(px, py), pz);
            let mut changed = 0;
            for axis in 0..3 {
                let plane = self.planes[axis][lane];
                let passed = plane <= exit;
                let here = self.slice[axis][lane];
                let next = here.wrapping_add(if passed { self.step[axis][lane] } else { 0 });
                self.slice[axis][lane] = next;
                self.planes[axis][lane] = plane + if passed { self.between[axis][lane] } else { 0.0 };
                changed |= here ^ next;
            }
            let within = within([cell[0][lane], cell[1][lane], cell[2][lane]]);
            numbers[lane] = self.node[lane].wrapping_mul(BRICK as u32) + within;
            occupied[lane] = (self.bits[lane] >> within) as u32 & 1;
            divided[lane] = (self.divided[lane] >> within) as u32 & 1;
            crossed[lane] = if self.shift[lane] == edge { EDGE } else { changed };
            self.enter[lane] = greater(exit, self.enter[lane]);
        }
        let visited = nonzero(s, &occupied) & self.active;
        let descended = nonzero(s, &divided) & visited;
        let mut left = descended;
        while let Some(lane) = next_lane(&mut left) {
            self.enter[lane] = before[lane];
            let brick = visit.brick(numbers[lane] as usize);
            self.descend(grid, lane, [cell[0][lane], cell[1][lane], cell[2][lane]], brick);
        }
        visit.cells(visited & !descended, &numbers, &mut self.limit);
        let mut goes_on = 0;
        let mut leaves = 0;
        for at in (0..ROW).step_by(S::LANES) {
            goes_on |= s.bits(s.le(s.load(&self.enter[at..]), s.load(&self.limit[at..]))) << at;
            leaves |= s.bits(s.lt_u(s.splat_u(EDGE - 1), s.load_u(&crossed[at..]))) << at;
        }
        self.active &= goes_on;
        self.entering = leaves & self.active & !descended;
        if top > 0 {
            let mut leaving = self.entering;
            while let Some(lane) = next_lane(&mut leaving) {
                if self.shift[lane] < top && self.ascend(grid, lane, crossed[lane]) {
                    self.entering &= !(1 << lane);
                }
            }
        }
    }

    /// Goes into the bricks of the grid that the rays come to, cell by cell where they hold anything; tells of which lanes they do.
    #[inline(always)]
    fn enter_bricks(&mut self, grid: &BrickGrid) -> u32 {
        let top = grid.top();
        let edge = top + SHIFT;
        let mut brick = self.slice;
        let mut index = [0; ROW];
        for lane in 0..ROW {
            let up = if self.shift[lane] == edge { 0 } else { SHIFT };
            for axis in &mut brick {
                axis[lane] >>= up;
            }
            index[lane] = grid.brick_at([brick[0][lane], brick[1][lane], brick[2][lane]]);
        }
        let mut entering = self.entering;
        let mut enters = [0u32; ROW];
        let mut full = 0;
        while let Some(lane) = next_lane(&mut entering) {
            self.hold(grid, lane, index[lane]);
            let bits = self.bits[lane];
            self.shift[lane] = if bits == 0 { edge } else { top };
            full |= u32::from(bits != 0) << lane;
            enters[lane] = 1;
        }
        for (axis, brick) in brick.iter().enumerate() {
            for lane in 0..ROW {
                let (shift, outer) = (self.shift[lane], brick[lane]);
                let here = cell_at(self.start[axis][lane] + self.enter[lane] * self.delta[axis][lane]);
                let slice = if shift == edge { outer } else { slice_within(here, top, outer) };
                let plane = slice.wrapping_add(self.forward[axis][lane]);
                let [plane, between] = planes(plane, shift, self.scale[axis][lane], self.offset[axis][lane]);
                let enters = enters[lane] != 0;
                self.slice[axis][lane] = if enters { slice } else { self.slice[axis][lane] };
                self.planes[axis][lane] = if enters { plane } else { self.planes[axis][lane] };
                self.between[axis][lane] = if enters { between } else { self.between[axis][lane] };
            }
        }
        self.entering = 0;
        full
    }

    /// Goes into the brick that a divided cell holds.
    fn descend(&mut self, grid: &BrickGrid, lane: usize, cell: [u32; 3], brick: u32) {
        let shift = self.shift[lane] - SHIFT;
        self.parents[lane][(shift / SHIFT) as usize] = self.node[lane];
        self.hold(grid, lane, brick);
        let mut slice = [0; 3];
        for axis in 0..3 {
            let here = cell_at(self.start[axis][lane] + self.enter[lane] * self.delta[axis][lane]);
            slice[axis] = slice_within(here, shift, cell[axis]);
        }
        self.resume(lane, slice, shift);
    }

    /// Goes back into the brick that holds what the ray has left; `false` if that is none but the grid.
    fn ascend(&mut self, grid: &BrickGrid, lane: usize, mut crossed: u32) -> bool {
        let mut slice = [0, 1, 2].map(|axis: usize| self.slice[axis][lane]);
        let mut shift = self.shift[lane];
        let mut node = self.node[lane];
        while crossed >= EDGE {
            if shift == grid.top() {
                for (to, slice) in self.slice.iter_mut().zip(slice) {
                    to[lane] = slice;
                }
                self.shift[lane] = shift;
                return false;
            }
            slice = slice.map(|c| c >> SHIFT);
            crossed >>= SHIFT;
            node = self.parents[lane][(shift / SHIFT) as usize];
            shift += SHIFT;
        }
        self.hold(grid, lane, node);
        self.resume(lane, slice, shift);
        true
    }

    /// Takes a brick for the one that the ray is in.
    #[inline(always)]
    fn hold(&mut self, grid: &BrickGrid, lane: usize, brick: u32) {
        self.node[lane] = brick;
        self.bits[lane] = grid.occupied[brick as usize];
        self.divided[lane] = grid.divided_cells(brick);
    }

    /// Goes on from these slices of 2^shift cells.
    fn resume(&mut self, lane: usize, slice: [u32; 3], shift: u32) {
        self.shift[lane] = shift;
        for (axis, slice) in slice.into_iter().enumerate() {
            let plane = slice.wrapping_add(self.forward[axis][lane]);
            self.slice[axis][lane] = slice;
            [self.planes[axis][lane], self.between[axis][lane]] =
                planes(plane, shift, self.scale[axis][lane], self.offset[axis][lane]);
        }
    }
}

/// The lanes that are not 0, as bits.
#[inline(always)]
fn nonzero<S: Simd>(s: S, values: &Lanes<u32>) -> u32 {
    let mut bits = 0;
    for at in (0..ROW).step_by(S::LANES) {
        bits |= s.bits(s.lt_u(s.splat_u(0), s.load_u(&values[at..]))) << at;
    }
    bits
}
