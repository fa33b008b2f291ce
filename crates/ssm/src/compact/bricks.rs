//! The cells of a grid by bricks of 4×4×4, with a bit for each cell that holds anything, and the
//! walk of a ray through them that steps over empty bricks at once. A cell may be divided again into a
//! brick of its own.

use super::ID;
use super::brick::{BRICK, EDGE, SHIFT, cell_of, within};
use super::segment::{ClippedSegment, Frame, SegmentRows, UnitBox, greater};
use crate::register::Word;
use accel::grid::Grid;
use accel::{Aabb, BuildError, Ray};
use lanes::Simd;
use lanes::packet::rows;
use std::ops::Range;

/// Most levels of bricks within cells.
pub(super) const MAX_LEVELS: usize = 7;

/// How the cells lie, and which of them hold anything.
#[derive(Debug)]
pub(super) struct BrickGrid {
    /// Slices on each axis, of the finest level.
    finest: Grid,
    frame: Frame,
    /// How often a cell may be divided.
    levels: u32,
    /// Bricks of the grid itself on each axis.
    pub bricks: [u32; 3],
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

impl BrickGrid {
    /// The finest level of a grid whose cells may be divided so often, or less where slices
    /// would become too thin.
    pub fn new(grid: &Grid, levels: u32) -> Self {
        let finest =
            |levels: u32| Grid::new(*grid.bounds(), grid.resolution().map(|n| n << (SHIFT * levels)));
        let divided = (0..=levels.min(MAX_LEVELS as u32)).rev().find_map(|l| Some((finest(l).ok()?, l)));
        let (finest, levels) = divided.unwrap_or((*grid, 0));
        let bricks = grid.resolution().map(|n| n.div_ceil(EDGE));
        let frame = Frame::new(&finest);
        Self { finest, frame, levels, bricks, occupied: Box::new([]), divided: Box::new([]) }
    }

    /// How often a cell may be divided.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Two to this is the number of the finest cells along an edge of a cell of the grid itself.
    #[inline(always)]
    pub fn top(&self) -> u32 {
        SHIFT * self.levels
    }

    /// The finest slices on each axis.
    #[inline(always)]
    pub fn finest_slices(&self) -> [u32; 3] {
        self.finest.resolution()
    }

    /// The number of a brick of the grid itself; any number where there is no brick, as for lanes without a ray.
    #[inline(always)]
    pub fn brick_at(&self, [x, y, z]: [u32; 3]) -> u32 {
        let [bx, by, _] = self.bricks;
        z.wrapping_mul(by).wrapping_add(y).wrapping_mul(bx).wrapping_add(x)
    }

    /// Number of bricks of the grid itself.
    pub fn count(&self) -> u128 {
        self.bricks.iter().map(|n| u128::from(*n)).product()
    }

    /// Bytes of the bits.
    pub fn bytes(&self) -> u128 {
        (size_of_val(&*self.occupied) + size_of_val(&*self.divided)) as u128
    }

    /// The slices of the finest level that a box touches.
    pub fn slices(&self, bounds: &Aabb) -> [Range<u32>; 3] {
        [0, 1, 2].map(|axis| self.finest.slices(axis, bounds))
    }

    /// Appends the cells of the grid that any of these slices of the finest level reach, brick by brick.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory.
    pub fn cells(&self, objects: &[[Range<u32>; 3]], found: &mut Vec<Word>) -> Result<(), BuildError> {
        let bricks_of = |of: &[Range<u32>; 3]| of.each_ref().map(|r| at_level(r, self.levels + 1));
        let volume = |of: &[Range<u32>; 3]| of.iter().map(|r| u64::from(r.end - r.start)).product::<u64>();
        let own: u64 = objects.iter().map(|object| volume(&bricks_of(object))).sum();
        let Some(hull) = objects.iter().map(bricks_of).reduce(|a, b| {
            [0, 1, 2].map(|axis| a[axis].start.min(b[axis].start)..a[axis].end.max(b[axis].end))
        }) else {
            return Ok(());
        };
        // All objects brick by brick, unless they lie so far apart that most bricks between hold none of them.
        if volume(&hull) * objects.len() as u64 <= WORTH_SORTING * own {
            accel::make_room(ID, found, volume(&hull) as usize)?;
            each_place(&hull, |brick| {
                let bits = objects.iter().fold(0, |bits, object| bits | self.within(object, brick));
                if bits != 0 {
                    found.push(self.word(brick, bits));
                }
            });
            return Ok(());
        }
        accel::make_room(ID, found, own as usize)?;
        for object in objects {
            each_place(&bricks_of(object), |brick| {
                found.push(self.word(brick, self.within(object, brick)));
            });
        }
        found.sort_unstable_by_key(|word| word.first);
        found.dedup_by(|word, kept| {
            let same = word.first == kept.first;
            kept.bits |= if same { word.bits } else { 0 };
            same
        });
        Ok(())
    }

    /// The cells of a brick of the grid that these slices of the finest level reach.
    fn within(&self, object: &[Range<u32>; 3], brick: [u32; 3]) -> u64 {
        places(&object.each_ref().map(|r| at_level(r, self.levels)), brick)
    }

    fn word(&self, brick: [u32; 3], bits: u64) -> Word {
        Word { first: self.brick_at(brick) * BRICK as u32, bits }
    }

    /// The slices of the grid in which a cell lies, of the grid's own level.
    pub fn place(&self, cell: u32) -> [u32; 3] {
        let (brick, within) = (cell / BRICK as u32, cell % BRICK as u32);
        let [bx, by, _] = self.bricks;
        cell_of([brick % bx, brick / bx % by, brick / (bx * by)], within)
    }

    /// A box in unit coordinates.
    pub fn unit_box(&self, bounds: &Aabb) -> UnitBox {
        self.frame.unit_box(bounds)
    }

    /// The part of a ray inside the grid.
    #[inline(always)]
    pub fn clip(&self, ray: &Ray) -> SegmentRows {
        self.frame.clip(ray)
    }

    /// The parts of up to 16 rays inside the grid; there must be one.
    #[inline(always)]
    pub fn clip_all<S: Simd>(&self, s: S, rays: &[Ray]) -> SegmentRows {
        match rays {
            [ray] => self.clip(ray),
            _ => self.frame.clip_rows(s, &rows(s, rays)),
        }
    }

    /// Visits the occupied cells on a segment up to s = `limit`, at most 1, in order.
    #[inline(always)]
    pub fn walk<V: Visit>(&self, segment: &ClippedSegment, mut limit: f32, visit: &mut V) {
        let top = self.top();
        let edge = top + SHIFT;
        let mut brick = segment.cell(0.0).map(|c| c >> edge);
        let mut enter = 0f32;
        loop {
            visit.step();
            let index = self.brick_at(brick);
            let mut bits = self.occupied[index as usize];
            if bits == 0 {
                let mut steps = segment.from(brick, edge);
                enter = greater(steps.advance(), enter);
                if enter > limit {
                    return;
                }
                brick = steps.slice;
                continue;
            }
            let mut node = index;
            let mut parents = [0u32; MAX_LEVELS];
            let mut shift = top;
            let mut cells = segment.from(segment.cell_within(enter, shift, brick), shift);
            'node: loop {
                visit.step();
                let cell = cells.slice;
                let within = within(cell);
                let exit = cells.advance();
                if bits >> within & 1 != 0 {
                    let number = node as usize * BRICK + within as usize;
                    if shift > 0 && self.is_divided(node, within) {
                        shift -= SHIFT;
                        parents[(shift / SHIFT) as usize] = node;
                        node = visit.brick(number);
                        bits = self.occupied[node as usize];
                        cells = segment.from(segment.cell_within(enter, shift, cell), shift);
                        continue;
                    }
                    limit = limit.min(visit.cell(number));
                }
                enter = greater(exit, enter);
                if enter > limit {
                    return;
                }
                let mut next = cells.slice;
                let mut crossed = (cell[0] ^ next[0]) | (cell[1] ^ next[1]) | (cell[2] ^ next[2]);
                if crossed < EDGE {
                    continue;
                }
                while crossed >= EDGE {
                    next = next.map(|c| c >> SHIFT);
                    if shift == top {
                        brick = next;
                        break 'node;
                    }
                    crossed >>= SHIFT;
                    node = parents[(shift / SHIFT) as usize];
                    shift += SHIFT;
                }
                cells = segment.from(next, shift);
                bits = self.occupied[node as usize];
            }
        }
    }

    /// Whether this cell of the grid's own is divided.
    pub fn divides(&self, cell: usize) -> bool {
        self.is_divided((cell / BRICK) as u32, (cell % BRICK) as u32)
    }

    /// Whether this cell of a brick is divided.
    #[inline(always)]
    pub fn is_divided(&self, node: u32, within: u32) -> bool {
        self.divided_cells(node) >> within & 1 != 0
    }

    /// The divided cells of a brick.
    #[inline(always)]
    pub fn divided_cells(&self, node: u32) -> u64 {
        self.divided.get(node as usize).copied().unwrap_or(0)
    }
}

/// So many words put in order take as long as looking at one object in one brick, about.
const WORTH_SORTING: u64 = 8;

fn each_place([xs, ys, zs]: &[Range<u32>; 3], mut with: impl FnMut([u32; 3])) {
    for z in zs.clone() {
        for y in ys.clone() {
            for x in xs.clone() {
                with([x, y, z]);
            }
        }
    }
}

/// The cells of a brick in these slices, as bits.
pub(super) fn places(slices: &[Range<u32>; 3], brick: [u32; 3]) -> u64 {
    let [x, y, z] = [0, 1, 2].map(|a| {
        let first = brick[a] * EDGE;
        let end = slices[a].end.saturating_sub(first).min(EDGE);
        let start = slices[a].start.saturating_sub(first).min(end);
        (1u128 << (16 * end)) - (1u128 << (16 * start))
    });
    // A bit for each slice, as far apart as cells are numbered.
    let (z, y) = (z as u64 & 0x0001_0001_0001_0001, y as u64 & 0x0001_0001_0001_0001);
    let y = (y | y >> 12 | y >> 24 | y >> 36) & 0x1111;
    let x = x as u64 & 0x0001_0001_0001_0001;
    let x = (x | x >> 15 | x >> 30 | x >> 45) & 0xf;
    x * y * z
}

/// Slices of the finest level as slices that many levels up.
pub(super) fn at_level(range: &Range<u32>, levels: u32) -> Range<u32> {
    range.start >> (SHIFT * levels)..((range.end - 1) >> (SHIFT * levels)) + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_the_cells_in_all_three_ranges() {
        for (xs, ys, zs) in [(0..4, 0..4, 0..4), (1..3, 2..4, 0..1), (5..9, 0..20, 3..7), (9..11, 0..1, 0..1)]
        {
            let mut expected = 0u64;
            each_place(&[4..8, 0..4, 4..8], |[x, y, z]| {
                if xs.contains(&x) && ys.contains(&y) && zs.contains(&z) {
                    expected |= 1 << ((x - 4) + 4 * y + 16 * (z - 4));
                }
            });
            assert_eq!(places(&[xs, ys, zs], [1, 0, 1]), expected);
        }
    }
}
