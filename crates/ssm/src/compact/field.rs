//! The cells of a grid by bricks of 4×4×4, with a bit for each cell that holds anything, and the
//! walk of a ray through them that steps over empty bricks at once.

use accel::grid::{Grid, Segment};
use std::ops::Range;

/// Cells along an edge of a brick.
const EDGE: u32 = 4;
/// Cells of a brick.
pub(super) const BRICK: usize = 64;

/// The segment is mapped into the lattice of cells shrunk by this on each side: its points never
/// lie on the outer planes, so the walk needs no test for the last slice. Small
/// against the grid's own margin, which makes up for it.
const INSET: f32 = 1.0 / (1 << 20) as f32;

/// A component of a segment below which it counts as parallel to the slices.
const PARALLEL: f32 = 1.0 / (1 << 23) as f32;

/// The layout of cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Slices on each axis.
    resolution: [u32; 3],
    /// Bricks on each axis.
    bricks: [u32; 3],
}

impl Layout {
    pub fn new(resolution: [u32; 3]) -> Self {
        Self { resolution, bricks: resolution.map(|n| n.div_ceil(EDGE)) }
    }

    /// Number of bricks.
    pub fn bricks(&self) -> u128 {
        self.bricks.iter().map(|n| u128::from(*n)).product()
    }

    /// Appends the numbers of the cells in these slices.
    pub fn cells(&self, [xs, ys, zs]: [Range<u32>; 3], found: &mut Vec<u32>) {
        let [bx, by, _] = self.bricks;
        for z in zs {
            for y in ys.clone() {
                let row = (z / EDGE * by + y / EDGE) * bx;
                let within = z % EDGE * 16 + y % EDGE * 4;
                found.extend(xs.clone().map(|x| (row + x / EDGE) * BRICK as u32 + within + x % EDGE));
            }
        }
    }

    /// Walks a segment through the cells whose bit is set in `occupied`, a word for each brick, in order.
    ///
    /// `visit` gets the number of a cell and returns up to which s cells must
    /// be looked at; −∞ ends the walk. `step` is told of each brick, and of each cell of bricks that hold anything.
    #[inline(always)]
    pub fn walk(
        &self,
        occupied: &[u64],
        segment: &Segment,
        mut visit: impl FnMut(usize) -> f32,
        mut step: impl FnMut(),
    ) {
        let rail = Rail::new(self.resolution, segment);
        let [bx, by, _] = self.bricks;
        let stride = [1, bx, bx * by];
        let mut cell = rail.cell(0.0, self.resolution);
        let mut brick = cell.map(|c| c / EDGE);
        let mut index = brick[0] + brick[1] * stride[1] + brick[2] * stride[2];
        let mut next = [0, 1, 2].map(|a| rail.plane(a, brick[a] * EDGE, EDGE));
        let mut enter = 0f32;
        let mut limit = 1f32;
        loop {
            step();
            let mut axis = first(next);
            let mut exit = next[axis].max(enter);
            let bits = occupied[index as usize];
            if bits != 0 {
                cell = rail.cell(enter, self.resolution);
                for a in 0..3 {
                    cell[a] = cell[a].clamp(brick[a] * EDGE, brick[a] * EDGE + (EDGE - 1));
                }
                let mut near = [0, 1, 2].map(|a| rail.plane(a, cell[a], 1));
                loop {
                    step();
                    axis = first(near);
                    exit = near[axis].max(enter);
                    let within = cell[0] % EDGE + cell[1] % EDGE * 4 + cell[2] % EDGE * 16;
                    if bits >> within & 1 != 0 {
                        limit = limit.min(visit(index as usize * BRICK + within as usize));
                    }
                    if exit > limit {
                        return;
                    }
                    enter = exit;
                    let from = cell[axis] / EDGE;
                    cell[axis] = cell[axis].wrapping_add(rail.step[axis]);
                    if cell[axis] / EDGE != from {
                        break;
                    }
                    near[axis] = rail.plane(axis, cell[axis], 1);
                }
            }
            if exit > limit {
                return;
            }
            enter = exit;
            brick[axis] = brick[axis].wrapping_add(rail.step[axis]);
            index = index.wrapping_add(rail.step[axis].wrapping_mul(stride[axis]));
            next[axis] = rail.plane(axis, brick[axis] * EDGE, EDGE);
        }
    }
}

/// The axis of the least of three numbers.
#[inline(always)]
fn first([x, y, z]: [f32; 3]) -> usize {
    if x <= y {
        if x <= z { 0 } else { 2 }
    } else if y <= z {
        1
    } else {
        2
    }
}

/// A segment in units of cells.
struct Rail {
    start: [f32; 3],
    delta: [f32; 3],
    /// Plane p of an axis is met at s = p·scale + offset.
    scale: [f32; 3],
    offset: [f32; 3],
    /// 1, or −1 in two's complement.
    step: [u32; 3],
    forward: [u32; 3],
}

impl Rail {
    #[inline(always)]
    fn new(resolution: [u32; 3], segment: &Segment) -> Self {
        let (start, delta) = (segment.start.to_array(), segment.delta.to_array());
        let mut rail = Self {
            start: [0.0; 3],
            delta: [0.0; 3],
            scale: [0.0; 3],
            offset: [f32::INFINITY; 3],
            step: [1; 3],
            forward: [1; 3],
        };
        for a in 0..3 {
            let n = resolution[a] as f32;
            let shrunk = 1.0 - 2.0 * INSET;
            let (unit, along) = (start[a] * shrunk + INSET, delta[a] * shrunk);
            (rail.start[a], rail.delta[a]) = (unit * n, along * n);
            if delta[a].abs() >= PARALLEL {
                let inverse = 1.0 / along;
                rail.scale[a] = inverse / n;
                rail.offset[a] = -unit * inverse;
            }
            if delta[a] < 0.0 {
                rail.step[a] = u32::MAX;
                rail.forward[a] = 0;
            }
        }
        rail
    }

    /// Where the walk leaves the `width` slices from `slice` on, on one axis.
    #[inline(always)]
    fn plane(&self, axis: usize, slice: u32, width: u32) -> f32 {
        (slice.wrapping_add(self.forward[axis] * width)) as f32 * self.scale[axis] + self.offset[axis]
    }

    /// The cell at s.
    #[inline(always)]
    fn cell(&self, s: f32, resolution: [u32; 3]) -> [u32; 3] {
        [0, 1, 2].map(|a| ((self.start[a] + s * self.delta[a]) as u32).min(resolution[a] - 1))
    }
}

/// The slices of a box on each axis.
pub(super) fn slices(grid: &Grid, bounds: &accel::Aabb) -> [Range<u32>; 3] {
    [0, 1, 2].map(|axis| grid.slices(axis, bounds))
}
