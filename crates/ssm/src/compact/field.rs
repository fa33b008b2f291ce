//! The cells of a grid by bricks of 4×4×4, with a bit for each cell that holds anything, and the
//! walk of a ray through them that steps over empty bricks at once. A cell may be divided again into a
//! brick of its own.

use super::way::{ClippedSegment, Frame, advance};
use accel::grid::Grid;
use accel::{Aabb, Ray};
use std::ops::Range;

/// Cells along an edge of a brick.
pub(super) const EDGE: u32 = 4;
/// Two to this is [`EDGE`].
const SHIFT: u32 = 2;
/// Cells of a brick.
pub(super) const BRICK: usize = 64;

/// Most levels of bricks within cells.
const MOST_LEVELS: usize = 7;

/// How the cells lie, and which of them hold anything.
#[derive(Debug)]
pub(super) struct Field {
    /// Slices on each axis, of the finest level.
    lattice: Grid,
    frame: Frame,
    /// How often a cell may be divided.
    levels: u32,
    /// Bricks of the grid itself on each axis.
    bricks: [u32; 3],
    /// A bit for each cell of each brick; those of divided cells come behind the grid's own.
    pub occupied: Box<[u64]>,
    /// A bit for each divided cell; empty if there is none.
    pub divided: Box<[u64]>,
}

/// What is done at the cells of a walk.
pub(super) trait Visit {
    /// Looks at a cell that holds references; returns up to which s others must be
    /// looked at, −∞ to end the walk. Must be `#[inline(always)]`.
    fn cell(&mut self, number: usize) -> f32;
    /// The brick that the divided cell `number` holds.
    fn brick(&self, number: usize) -> u32;
    /// Told of every step. Must be `#[inline(always)]`.
    fn step(&mut self);
}

impl Field {
    /// The lattice of a grid whose cells may be divided so often, or less where slices
    /// would become too thin.
    pub fn new(grid: &Grid, levels: u32) -> Self {
        let finest =
            |levels: u32| Grid::new(*grid.bounds(), grid.resolution().map(|n| n << (SHIFT * levels)));
        let divided = (0..=levels.min(MOST_LEVELS as u32)).rev().find_map(|l| Some((finest(l).ok()?, l)));
        let (lattice, levels) = divided.unwrap_or((*grid, 0));
        let bricks = grid.resolution().map(|n| n.div_ceil(EDGE));
        let frame = Frame::new(&lattice);
        Self { lattice, frame, levels, bricks, occupied: Box::new([]), divided: Box::new([]) }
    }

    /// How often a cell may be divided.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Number of bricks of the grid itself.
    pub fn bricks(&self) -> u128 {
        self.bricks.iter().map(|n| u128::from(*n)).product()
    }

    /// The slices of the finest level that a box touches.
    pub fn slices(&self, bounds: &Aabb) -> [Range<u32>; 3] {
        [0, 1, 2].map(|axis| self.lattice.slices(axis, bounds))
    }

    /// Appends the numbers of the cells in these slices of the finest level.
    pub fn cells(&self, slices: &[Range<u32>; 3], found: &mut Vec<u32>) {
        let [xs, ys, zs] = slices.each_ref().map(|r| at_level(r, self.levels));
        let [bx, by, _] = self.bricks;
        for z in zs {
            for y in ys.clone() {
                let row = (z / EDGE * by + y / EDGE) * bx;
                let within = z % EDGE * 16 + y % EDGE * 4;
                found.extend(xs.clone().map(|x| (row + x / EDGE) * BRICK as u32 + within + x % EDGE));
            }
        }
    }

    /// The slices of the grid in which a cell lies, of the grid's own level.
    pub fn place(&self, cell: u32) -> [u32; 3] {
        let (brick, within) = (cell / BRICK as u32, cell % BRICK as u32);
        let [bx, by, _] = self.bricks;
        let brick = [brick % bx, brick / bx % by, brick / (bx * by)];
        let within = [within % EDGE, within / EDGE % EDGE, within / (EDGE * EDGE)];
        [0, 1, 2].map(|a| brick[a] * EDGE + within[a])
    }

    /// The part of a ray inside the grid.
    #[inline(always)]
    pub fn clip(&self, ray: &Ray) -> Option<ClippedSegment> {
        self.frame.clip(ray)
    }

    /// Visits the occupied cells on a way up to s = `limit`, at most 1, in order.
    #[inline(always)]
    pub fn walk<V: Visit>(&self, way: &ClippedSegment, mut limit: f32, visit: &mut V) {
        let [bx, by, _] = self.bricks;
        let top = SHIFT * self.levels;
        let edge = top + SHIFT;
        let mut brick = way.cell(0.0).map(|c| c >> edge);
        let mut enter = 0f32;
        loop {
            visit.step();
            let index = (brick[2] * by + brick[1]) * bx + brick[0];
            let mut bits = self.occupied[index as usize];
            if bits == 0 {
                let (next, exit) = advance(way, brick, way.planes(brick, edge));
                enter = exit.max(enter);
                if enter > limit {
                    return;
                }
                brick = next;
                continue;
            }
            let mut node = index;
            let mut parents = [0u32; MOST_LEVELS];
            let mut shift = top;
            let mut cell = way.cell_within(enter, shift, brick);
            'node: loop {
                visit.step();
                let within = cell[0] % EDGE + cell[1] % EDGE * 4 + cell[2] % EDGE * 16;
                let (next, exit) = advance(way, cell, way.planes(cell, shift));
                if bits >> within & 1 != 0 {
                    let number = node as usize * BRICK + within as usize;
                    if shift > 0 && self.is_divided(node, within) {
                        shift -= SHIFT;
                        parents[(shift / SHIFT) as usize] = node;
                        node = visit.brick(number);
                        bits = self.occupied[node as usize];
                        cell = way.cell_within(enter, shift, cell);
                        continue;
                    }
                    limit = limit.min(visit.cell(number));
                }
                enter = exit.max(enter);
                if enter > limit {
                    return;
                }
                let mut crossed = (cell[0] ^ next[0]) | (cell[1] ^ next[1]) | (cell[2] ^ next[2]);
                cell = next;
                if crossed < EDGE {
                    continue;
                }
                while crossed >= EDGE {
                    cell = cell.map(|c| c >> SHIFT);
                    if shift == top {
                        brick = cell;
                        break 'node;
                    }
                    crossed >>= SHIFT;
                    node = parents[(shift / SHIFT) as usize];
                    shift += SHIFT;
                }
                bits = self.occupied[node as usize];
            }
        }
    }

    #[inline(always)]
    fn is_divided(&self, node: u32, within: u32) -> bool {
        self.divided.get(node as usize).is_some_and(|bits| bits >> within & 1 != 0)
    }
}

/// Slices of the finest level as slices that many levels up.
pub(super) fn at_level(range: &Range<u32>, levels: u32) -> Range<u32> {
    range.start >> (SHIFT * levels)..((range.end - 1) >> (SHIFT * levels)) + 1
}
