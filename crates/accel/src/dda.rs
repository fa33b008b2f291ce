//! The walk of a ray through the cells of a grid: a 3D DDA, after J. Amanatides and
//! A. Woo, *A Fast Voxel Traversal Algorithm for Ray Tracing*, Eurographics 1987, with planes computed anew instead
//! of summed up, so that its error does not grow with the number of steps.

use crate::grid::{Grid, Segment};
use crate::tolerance::PARALLEL;

/// A cell on a ray's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Slice numbers.
    pub slice: [u32; 3],
    /// Where the ray enters it, in the s of [`Segment`].
    pub enter: f32,
    /// Where it leaves.
    pub exit: f32,
}

/// The cells on a ray's way, in order.
#[derive(Clone, Debug)]
pub struct Walk {
    cell: [u32; 3],
    enter: f32,
    /// Where the next slice begins on each axis.
    next: [f32; 3],
    start: [f32; 3],
    inverse: [f32; 3],
    thickness: [f32; 3],
    last: [u32; 3],
    done: bool,
}

impl Walk {
    /// Walks `segment` through `grid`.
    #[inline]
    pub fn new(grid: &Grid, segment: &Segment) -> Self {
        let resolution = grid.resolution();
        let start = segment.start.to_array();
        let delta = segment.delta.to_array();
        let cell = [0, 1, 2].map(|a| ((start[a] * resolution[a] as f32) as u32).min(resolution[a] - 1));
        let mut walk = Self {
            cell,
            enter: 0.0,
            next: [f32::INFINITY; 3],
            start,
            inverse: delta.map(|d| if d.abs() < PARALLEL as f32 { 0.0 } else { 1.0 / d }),
            thickness: resolution.map(|n| 1.0 / n as f32),
            last: resolution.map(|n| n - 1),
            done: false,
        };
        for axis in 0..3 {
            walk.next[axis] = walk.boundary(axis);
        }
        walk
    }

    /// Where the ray leaves the present slice of an axis.
    #[inline(always)]
    fn boundary(&self, axis: usize) -> f32 {
        let inverse = self.inverse[axis];
        let plane = match inverse {
            i if i > 0.0 && self.cell[axis] < self.last[axis] => self.cell[axis] + 1,
            i if i < 0.0 && self.cell[axis] > 0 => self.cell[axis],
            _ => return f32::INFINITY,
        };
        (plane as f32 * self.thickness[axis] - self.start[axis]) * inverse
    }
}

impl Iterator for Walk {
    type Item = Cell;

    #[inline]
    fn next(&mut self) -> Option<Cell> {
        if self.done {
            return None;
        }
        let [x, y, z] = self.next;
        let axis = if x <= y {
            if x <= z { 0 } else { 2 }
        } else if y <= z {
            1
        } else {
            2
        };
        // Rounding may put a boundary a little before the point reached already.
        let exit = self.next[axis].max(self.enter);
        let cell = Cell { slice: self.cell, enter: self.enter, exit };
        // NaN, which an unusable ray gives, ends the walk too.
        let goes_on = exit <= 1.0;
        if !goes_on {
            self.done = true;
        } else {
            self.enter = exit;
            self.cell[axis] =
                if self.inverse[axis] > 0.0 { self.cell[axis] + 1 } else { self.cell[axis] - 1 };
            self.next[axis] = self.boundary(axis);
        }
        Some(cell)
    }
}

#[cfg(test)]
mod tests;
