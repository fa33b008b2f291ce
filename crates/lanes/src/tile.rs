//! A part of an image.

use accel::Raster;
use std::ops::Range;

/// A tile of a raster: square cells of pixels side by side.
///
/// Places are columns and rows of pixels, whose centres lie at halves; sizes go from a middle to the centre of the farthest pixel.
#[derive(Clone, Copy, Debug)]
pub struct Tile<'a> {
    /// The raster.
    pub raster: &'a Raster,
    /// The tile's middle.
    pub middle: [f32; 2],
    /// Half the tile's size.
    pub half: [f32; 2],
    /// Half a cell's size.
    pub half_cell: f32,
    /// Pixels across a cell.
    across: f32,
    first: [u32; 2],
    cells: [u32; 2],
}

impl<'a> Tile<'a> {
    /// Of these rows and columns of cells, each of so many pixels across.
    pub fn new(raster: &'a Raster, rows: Range<u32>, cols: Range<u32>, across: u32) -> Self {
        let across = across as f32;
        let middle = |cells: &Range<u32>| (cells.start + cells.end) as f32 * (0.5 * across);
        let half = |cells: f32| 0.5 * (cells * across - 1.0);
        Self {
            raster,
            middle: [middle(&cols), middle(&rows)],
            half: [half(cols.len() as f32), half(rows.len() as f32)],
            half_cell: half(1.0),
            across,
            first: [cols.start, rows.start],
            cells: [cols.len() as u32, rows.len() as u32],
        }
    }

    /// The middle of a cell, from that of the tile.
    #[inline(always)]
    pub fn cell(&self, row: u32, col: u32) -> [f32; 2] {
        let place = |cell: u32, first: u32, cells: u32| {
            ((2 * (cell - first) + 1) as f32 - cells as f32) * (0.5 * self.across)
        };
        [place(col, self.first[0], self.cells[0]), place(row, self.first[1], self.cells[1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Projection, Vec3};

    #[test]
    fn every_pixel_is_within_its_cell_and_the_tile() {
        let raster = Raster {
            projection: Projection::Parallel,
            rows: 100,
            cols: 100,
            origin: Vec3::ZERO,
            forward: Vec3::Z,
            right: Vec3::X,
            down: Vec3::Y,
        };
        let tile = Tile::new(&raster, 3..8, 1..3, 4);
        let (mut farthest, mut farthest_in_cell) = ([0.0f32; 2], 0.0f32);
        for (row, col) in (12..32).flat_map(|row| (4..12).map(move |col| (row, col))) {
            let (pixel, cell) = ([col as f32 + 0.5, row as f32 + 0.5], tile.cell(row / 4, col / 4));
            for axis in 0..2 {
                let place = pixel[axis] - tile.middle[axis];
                farthest[axis] = farthest[axis].max(place.abs());
                farthest_in_cell = farthest_in_cell.max((place - cell[axis]).abs());
            }
        }
        assert_eq!((farthest, farthest_in_cell), (tile.half, tile.half_cell));
    }
}
