//! Tracing tile by tile.

use super::maps::GROUPS;
use super::{RasterMaps, THICKNESS};
use accel::objects::{BLOCK, Blocks};
use accel::packet::{Common, NearestPacket};
use accel::simd::{ROW, Row, Simd, Task};
use accel::{Count, Counters, Hit, Nearest, NoCount, Objects};
use rayon::prelude::*;
use std::ops::Range;

/// Pixels where two slices meet.
const CELL: usize = (THICKNESS * THICKNESS) as usize;

/// Blocks after which a tile's farthest hit is found again.
const PATIENCE: u32 = 4;

/// Rays and nearest hits of a tile's pixels, and values prepared for one block.
struct Tile<S: Simd, M> {
    rays: Vec<M>,
    best: Vec<NearestPacket<S>>,
    rows: Vec<Row>,
}

/// One row of tiles.
struct Band<'a, O: Objects, C> {
    maps: &'a RasterMaps<O>,
    row: u32,
    hits: &'a mut [Option<Hit>],
    count: C,
}

impl<O: Objects> RasterMaps<O> {
    /// The nearest hit of every pixel, row by row.
    ///
    /// # Panics
    /// If there is not one place for each pixel.
    pub fn trace(&self, hits: &mut [Option<Hit>]) {
        self.trace_counting::<NoCount>(hits);
    }

    /// What tracing costs.
    pub fn count(&self) -> Counters {
        let mut hits = vec![None; self.raster.len()];
        let mut sum = Counters::default();
        for part in self.trace_counting::<Counters>(&mut hits) {
            sum.merge(&part);
        }
        sum
    }

    fn trace_counting<C: Count>(&self, hits: &mut [Option<Hit>]) -> Vec<C> {
        assert_eq!(hits.len(), self.raster.len(), "one place for each pixel");
        if hits.is_empty() {
            return Vec::new();
        }
        let band = (self.settings.tile * THICKNESS) as usize * self.raster.cols as usize;
        let trace = |(row, hits): (usize, &mut [Option<Hit>])| {
            let band = Band { maps: self, row: row as u32, hits, count: C::default() };
            self.settings.simd.run(band)
        };
        if rayon::current_num_threads() == 1 {
            hits.chunks_mut(band).enumerate().map(trace).collect()
        } else {
            hits.par_chunks_mut(band).enumerate().map(trace).collect()
        }
    }

    /// The slices in tile number `tile`, of so many pixels in all.
    fn slices(&self, tile: u32, pixels: u32) -> Range<u32> {
        let across = self.settings.tile;
        tile * across..((tile + 1) * across).min(pixels.div_ceil(THICKNESS))
    }
}

impl<O: Objects, C: Count> Task for Band<'_, O, C> {
    type Out = C;

    #[inline(always)]
    fn run<S: Simd>(mut self, s: S) -> C {
        let maps = self.maps;
        let prepared = <O::Blocks as Blocks>::PREPARED_ROWS * GROUPS;
        let mut tile = Tile { rays: Vec::new(), best: Vec::new(), rows: vec![Row([0.0; ROW]); prepared] };
        let rows = maps.slices(self.row, maps.raster.rows);
        let across = maps.raster.cols.div_ceil(THICKNESS).div_ceil(maps.settings.tile);
        for col in 0..across {
            let cols = maps.slices(col, maps.raster.cols);
            tile.begin(s, maps, &rows, &cols);
            tile.trace(s, maps, (self.row, col), &rows, &cols, &mut self.count);
            tile.end(s, maps, &rows, &cols, self.hits);
        }
        self.count
    }
}

impl<S: Simd, M: Copy> Tile<S, M> {
    /// Packets that serve the pixels of a cell.
    const PACKETS: usize = CELL / S::LANES;

    /// Makes the rays. Lanes outside the image are switched off.
    #[inline(always)]
    fn begin<O: Objects>(&mut self, s: S, maps: &RasterMaps<O>, rows: &Range<u32>, cols: &Range<u32>)
    where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let raster = &maps.raster;
        self.rays.clear();
        self.best.clear();
        for row in rows.clone() {
            for col in cols.clone() {
                for packet in 0..Self::PACKETS {
                    let (mut x, mut y, mut t) = ([0.0; ROW], [0.0; ROW], [f32::INFINITY; ROW]);
                    for lane in 0..S::LANES {
                        let (r, c) = pixel(row, col, packet * S::LANES + lane);
                        (x[lane], y[lane]) = (c as f32 + 0.5, r as f32 + 0.5);
                        if r >= raster.rows || c >= raster.cols {
                            t[lane] = f32::NEG_INFINITY;
                        }
                    }
                    self.rays.push(maps.geometry.many(s, &raster.packet(s, s.load(&x), s.load(&y))));
                    self.best.push(NearestPacket::new(s, s.load(&t)));
                }
            }
        }
    }

    #[inline(always)]
    fn trace<O: Objects, C: Count>(
        &mut self,
        s: S,
        maps: &RasterMaps<O>,
        (row, col): (u32, u32),
        rows: &Range<u32>,
        cols: &Range<u32>,
        count: &mut C,
    ) where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let common = maps.raster.common();
        let across = cols.len();
        let mut farthest = f32::INFINITY;
        let mut patience = PATIENCE;
        for (i, (r, c)) in maps.tiles.of(row, col).enumerate() {
            count.words(2);
            let mut seen = r & c;
            while seen != 0 {
                let at = i * 64 + seen.trailing_zeros() as usize;
                seen &= seen - 1;
                let block = &maps.blocks[at];
                if block.depth[0] > farthest {
                    return;
                }
                patience -= 1;
                if patience == 0 {
                    patience = PATIENCE;
                    farthest = self.farthest(s);
                }
                count.blocks(1);
                let words = &maps.words[block.words as usize..][..block.len()];
                let (r_words, s_words) = words.split_at(block.rows as usize);
                let (top, bottom) = (rows.start.max(block.row), rows.end.min(block.row + block.rows));
                let (left, right) = (cols.start.max(block.col), cols.end.min(block.col + block.cols));
                let r_words = &r_words[(top - block.row) as usize..(bottom - block.row) as usize];
                let s_words = &s_words[(left - block.col) as usize..(right - block.col) as usize];
                let mut prepared = 0;
                for (r, row) in r_words.iter().zip(top..) {
                    let first = (row - rows.start) as usize * across + (left - cols.start) as usize;
                    count.words(s_words.len() as u64);
                    for (c, cell) in s_words.iter().zip(first..) {
                        let candidates = r & c;
                        if candidates != 0 {
                            count.cells(1);
                            self.cell(s, maps, at, cell, candidates, &common, &mut prepared, count);
                        }
                    }
                }
            }
        }
    }

    /// Tests a block's candidates in the pixels of one cell.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    fn cell<O: Objects, C: Count>(
        &mut self,
        s: S,
        maps: &RasterMaps<O>,
        block: usize,
        cell: usize,
        candidates: u64,
        common: &Common,
        prepared: &mut u32,
        count: &mut C,
    ) where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let each = <O::Blocks as Blocks>::PREPARED_ROWS;
        let depth = &maps.blocks[block].depth;
        count.candidates(u64::from(candidates.count_ones()));
        for packet in cell * Self::PACKETS..(cell + 1) * Self::PACKETS {
            let rays = &self.rays[packet];
            let mut best = self.best[packet];
            for (group, &depth) in depth.iter().enumerate() {
                let mut bits = candidates >> (group * ROW) & 0xffff;
                if bits == 0 {
                    continue;
                }
                if s.bits(s.le(s.splat(depth), best.t)) == 0 {
                    break;
                }
                let first = block * BLOCK + group * ROW;
                let rows = &mut self.rows[group * each..(group + 1) * each];
                if *prepared >> group & 1 == 0 {
                    *prepared |= 1 << group;
                    maps.geometry.prepare(s, first, common, rows);
                }
                count.tests(u64::from(bits.count_ones()));
                while bits != 0 {
                    let slot = first + bits.trailing_zeros() as usize;
                    bits &= bits - 1;
                    maps.geometry.packet_prepared(s, slot, common, rows, rays, &mut best);
                }
            }
            self.best[packet] = best;
        }
    }

    /// The farthest of the pixels' nearest hits so far.
    #[inline(always)]
    fn farthest(&self, s: S) -> f32 {
        let mut far = s.splat(f32::NEG_INFINITY);
        for best in &self.best {
            far = s.max(far, best.t);
        }
        let mut lanes = [f32::NEG_INFINITY; ROW];
        s.store(far, &mut lanes);
        lanes.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }

    /// Writes the hits to a row of tiles.
    #[inline(always)]
    fn end<O: Objects>(
        &self,
        s: S,
        maps: &RasterMaps<O>,
        rows: &Range<u32>,
        cols: &Range<u32>,
        hits: &mut [Option<Hit>],
    ) {
        let (height, width) = (maps.raster.rows, maps.raster.cols);
        let mut cells = self.best.chunks_exact(Self::PACKETS);
        let mut nearest = [Nearest::new(0.0); CELL];
        for row in rows.clone() {
            for col in cols.clone() {
                let Some(cell) = cells.next() else { return };
                for (packet, nearest) in cell.iter().zip(nearest.chunks_exact_mut(S::LANES)) {
                    packet.store(s, nearest);
                }
                for (i, nearest) in nearest.iter().enumerate() {
                    let (r, c) = pixel(row, col, i);
                    if r < height && c < width {
                        let at = (r - rows.start * THICKNESS) as usize * width as usize + c as usize;
                        hits[at] = nearest.hit();
                    }
                }
            }
        }
    }
}

/// Row and column of a cell's pixel number `i`.
#[inline(always)]
fn pixel(row: u32, col: u32, i: usize) -> (u32, u32) {
    let i = i as u32;
    (row * THICKNESS + i / THICKNESS, col * THICKNESS + i % THICKNESS)
}
