//! Tracing tile by tile.

use super::maps::GROUPS;
use super::{RasterMaps, THICKNESS};
use accel::parallel::map_chunks;
use accel::{Common, Count, Counters, Hit, Nearest, NoCount};
use lanes::packet::{NearestPacket, Packet};
use lanes::{
    BLOCK, Blocks, PackedObjects, ROW, Row, Shared, Simd, Task, Tile, next_bit, next_lane, prefetch,
};
use std::ops::Range;

/// Pixels where two slices meet.
const CELL: usize = (THICKNESS * THICKNESS) as usize;

/// Columns and rows of the middles of a cell's pixels, from its corner.
const MIDDLES: [[f32; CELL]; 2] = {
    let mut middles = [[0.0; CELL]; 2];
    let mut i = 0;
    while i < CELL {
        middles[0][i] = (i % THICKNESS as usize) as f32 + 0.5;
        middles[1][i] = (i / THICKNESS as usize) as f32 + 0.5;
        i += 1;
    }
    middles
};

/// A block's objects are held against each cell from so many on that they cover together: it takes about as long as one
/// test, and of small objects few are outside of a cell that their box touches.
const CULLED: u32 = 5 * BLOCK as u32;

/// Rays and nearest hits of a tile's pixels, and values prepared for one block.
struct TileTrace<S: Simd, M> {
    /// Slices of rows.
    rows: Range<u32>,
    /// Slices of columns.
    cols: Range<u32>,
    /// The cells whose rays are made: those that some block shows candidates in.
    open: Vec<bool>,
    closed: usize,
    /// The packet that held the farthest hit when it was last looked for.
    witness: usize,
    rays: Vec<M>,
    best: Vec<NearestPacket<S>>,
    prepared: Vec<Row>,
    culling: Vec<Row>,
}

/// A block in a tile, and which of its groups have been prepared.
struct AtBlock<'a> {
    at: usize,
    common: Common,
    tile: Tile<'a>,
    /// Whether objects are held against each cell before rays are.
    culls: bool,
    /// Objects that rays of the tile may hit, of groups that have been held against it.
    shown: u64,
    /// Groups prepared for culling, and for tests.
    culling: u32,
    tests: u32,
}

/// One row of tiles.
struct Band<'a, O: PackedObjects, C> {
    maps: &'a RasterMaps<O>,
    row: u32,
    hits: &'a mut [Option<Hit>],
    count: C,
}

impl<O: PackedObjects> RasterMaps<O> {
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
        map_chunks(hits, band, &|row, hits| {
            let band = Band { maps: self, row: row as u32, hits, count: C::default() };
            self.settings.simd.run(band)
        })
    }

    /// The slices in tile number `tile`, of so many pixels in all.
    fn slices(&self, tile: u32, pixels: u32) -> Range<u32> {
        let across = self.settings.tile;
        tile * across..((tile + 1) * across).min(pixels.div_ceil(THICKNESS))
    }
}

impl<O: PackedObjects, C: Count> Task for Band<'_, O, C> {
    type Out = C;

    #[inline(always)]
    fn run<S: Simd>(mut self, s: S) -> C {
        let maps = self.maps;
        let mut tile = TileTrace::<S, <O::Blocks as Blocks>::Many<S>>::new(s, maps);
        let across = maps.raster.cols.div_ceil(THICKNESS).div_ceil(maps.settings.tile);
        tile.rows = maps.slices(self.row, maps.raster.rows);
        for col in 0..across {
            tile.cols = maps.slices(col, maps.raster.cols);
            tile.open.fill(false);
            tile.closed = tile.rows.len() * tile.cols.len();
            tile.trace(s, maps, (self.row, col), self.hits, &mut self.count);
            tile.resolve(s, maps);
            tile.end(s, maps, self.hits);
        }
        self.count
    }
}

impl<S: Simd, M: Copy> TileTrace<S, M> {
    /// Packets that serve the pixels of a cell.
    const PACKETS: usize = CELL / S::LANES;

    #[inline(always)]
    fn new<O: PackedObjects>(s: S, maps: &RasterMaps<O>) -> Self
    where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let cells = (maps.settings.tile * maps.settings.tile) as usize;
        let any = maps.geometry.many(s, &Packet::of_raster(s, &maps.raster, s.splat(0.5), s.splat(0.5)));
        Self {
            rows: 0..0,
            cols: 0..0,
            open: vec![false; cells],
            closed: 0,
            witness: 0,
            rays: vec![any; cells * Self::PACKETS],
            best: vec![NearestPacket::new(s, s.splat(0.0)); cells * Self::PACKETS],
            prepared: vec![Row([0.0; ROW]); <O::Blocks as Blocks>::PREPARED_ROWS * GROUPS],
            culling: vec![Row([0.0; ROW]); <O::Blocks as Blocks>::CULLING_ROWS * GROUPS],
        }
    }

    /// Makes a cell's rays. Lanes outside the image are switched off. Where the cell's hits will be written is asked for from
    /// memory: an image is far larger than the caches, and its rows are far apart.
    #[inline(always)]
    fn open<O: PackedObjects>(&mut self, s: S, maps: &RasterMaps<O>, cell: usize, hits: &[Option<Hit>])
    where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let raster = &maps.raster;
        let row = (self.rows.start + (cell / self.cols.len()) as u32) * THICKNESS;
        let col = (self.cols.start + (cell % self.cols.len()) as u32) * THICKNESS;
        let inside = row + THICKNESS <= raster.rows && col + THICKNESS <= raster.cols;
        for line in hits
            .chunks_exact(raster.cols as usize)
            .skip((row - self.rows.start * THICKNESS) as usize)
            .take(THICKNESS as usize)
        {
            prefetch(&line[col as usize..(col + THICKNESS).min(raster.cols) as usize]);
        }
        for packet in 0..Self::PACKETS {
            let from = packet * S::LANES;
            let x = s.add(s.splat(col as f32), s.load(&MIDDLES[0][from..]));
            let y = s.add(s.splat(row as f32), s.load(&MIDDLES[1][from..]));
            let mut t = s.splat(f32::INFINITY);
            if !inside {
                let there = s.and(s.lt(x, s.splat(raster.cols as f32)), s.lt(y, s.splat(raster.rows as f32)));
                t = s.select(there, t, s.splat(f32::NEG_INFINITY));
            }
            let at = cell * Self::PACKETS + packet;
            self.rays[at] = maps.geometry.many(s, &Packet::of_raster(s, raster, x, y));
            self.best[at] = NearestPacket::new(s, t);
        }
        self.open[cell] = true;
        self.closed -= 1;
    }

    #[inline(always)]
    fn trace<O: PackedObjects, C: Count>(
        &mut self,
        s: S,
        maps: &RasterMaps<O>,
        (row, col): (u32, u32),
        hits: &[Option<Hit>],
        count: &mut C,
    ) where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let (rows, cols) = (self.rows.clone(), self.cols.clone());
        let common = maps.raster.common();
        let tile = Tile::new(&maps.raster, rows.clone(), cols.clone(), THICKNESS);
        let across = cols.len();
        let mut farthest = f32::INFINITY;
        for (i, (r, c)) in maps.tiles.of(row, col).enumerate() {
            count.words(2);
            let mut seen = r & c;
            while let Some(bit) = next_bit(&mut seen) {
                let at = i * 64 + bit;
                let block = &maps.blocks[at];
                farthest = self.farthest(s, farthest);
                if block.depth[0] > farthest {
                    return;
                }
                if seen != 0 {
                    let next = i * 64 + seen.trailing_zeros() as usize;
                    maps.geometry.prefetch(next);
                    let words = maps.blocks[next].words as usize;
                    maps.words[words..].first().map(prefetch);
                }
                count.blocks(1);
                let words = &maps.words[block.words as usize..][..block.len()];
                let (r_words, s_words) = words.split_at(block.rows as usize);
                let (top, bottom) = (rows.start.max(block.row), rows.end.min(block.row + block.rows));
                let (left, right) = (cols.start.max(block.col), cols.end.min(block.col + block.cols));
                let r_words = &r_words[(top - block.row) as usize..(bottom - block.row) as usize];
                let s_words = &s_words[(left - block.col) as usize..(right - block.col) as usize];
                let culls = <O::Blocks as Blocks>::CULLING_ROWS > 0 && block.cells > CULLED;
                let mut here = AtBlock { at, common, tile, culls, shown: u64::MAX, culling: 0, tests: 0 };
                let [first_x, mut y] = tile.cell(top, left);
                for (r, row) in r_words.iter().zip(top..) {
                    let mut x = first_x;
                    let first = (row - rows.start) as usize * across + (left - cols.start) as usize;
                    count.words(s_words.len() as u64);
                    for (c, cell) in s_words.iter().zip(first..) {
                        let candidates = r & c;
                        if candidates != 0 {
                            count.cells(1);
                            if !self.open[cell] {
                                self.open(s, maps, cell, hits);
                            }
                            self.cell(s, maps, &mut here, (cell, [x, y]), candidates, count);
                        }
                        x += THICKNESS as f32;
                    }
                    y += THICKNESS as f32;
                }
            }
        }
    }

    /// Tests a block's candidates in the pixels of one cell, whose middle is told from that of the tile.
    #[inline(always)]
    fn cell<O: PackedObjects, C: Count>(
        &mut self,
        s: S,
        maps: &RasterMaps<O>,
        block: &mut AtBlock,
        (cell, middle): (usize, [f32; 2]),
        mut candidates: u64,
        count: &mut C,
    ) where
        O::Blocks: Blocks<Many<S> = M>,
    {
        let each = <O::Blocks as Blocks>::PREPARED_ROWS;
        let culled_by = <O::Blocks as Blocks>::CULLING_ROWS;
        count.candidates(u64::from(candidates.count_ones()));
        candidates &= block.shown;
        let packets = cell * Self::PACKETS..(cell + 1) * Self::PACKETS;
        while candidates != 0 {
            let group = candidates.trailing_zeros() as usize / ROW;
            let mut bits = (candidates >> (group * ROW) & 0xffff) as u32;
            candidates &= !(0xffff << (group * ROW));
            let depth = s.splat(maps.blocks[block.at].depth[group]);
            let mut open = 0;
            for best in &self.best[packets.clone()] {
                open |= s.bits(s.le(depth, best.t));
            }
            if open == 0 {
                break;
            }
            let first = block.at * BLOCK + group * ROW;
            if block.culls {
                let rows = &mut self.culling[group * culled_by..(group + 1) * culled_by];
                if block.culling >> group & 1 == 0 {
                    block.culling |= 1 << group;
                    let shown = maps.geometry.prepare_culling(s, first, &block.tile, rows) & 0xffff;
                    block.shown &= !(0xffff << (group * ROW)) | u64::from(shown) << (group * ROW);
                    bits &= shown;
                    if bits == 0 {
                        continue;
                    }
                }
                bits &= O::Blocks::survivors(s, rows, middle);
                if bits == 0 {
                    continue;
                }
            }
            let rows = &mut self.prepared[group * each..(group + 1) * each];
            if block.tests >> group & 1 == 0 {
                block.tests |= 1 << group;
                maps.geometry.prepare(s, first, &block.common, rows);
            }
            count.tests(u64::from(bits.count_ones()));
            for packet in packets.clone() {
                // In memory: most tests look at no more of it than t.
                let (rays, best) = (&self.rays[packet], &mut self.best[packet]);
                let mut bits = bits;
                while let Some(lane) = next_lane(&mut bits) {
                    let at = Shared { slot: first + lane, common: &block.common, rows };
                    maps.geometry.packet_prepared(s, at, rays, best);
                }
            }
        }
    }

    /// The farthest of the pixels' nearest hits so far, which was `before`: it still is where the packet has it that had it then.
    #[inline(always)]
    fn farthest(&mut self, s: S, before: f32) -> f32 {
        let has = |packet: &NearestPacket<S>, t: f32| s.bits(s.le(s.splat(t), packet.t)) != 0;
        if self.closed != 0 || has(&self.best[self.witness], before) {
            return before;
        }
        let best = &self.best[..self.rows.len() * self.cols.len() * Self::PACKETS];
        let mut far = s.splat(f32::NEG_INFINITY);
        for best in best {
            far = s.max(far, best.t);
        }
        let far = s.most(far);
        self.witness = best.iter().position(|packet| has(packet, far)).unwrap_or(0);
        far
    }

    /// Decides the hits that tests left open.
    #[inline(always)]
    fn resolve<O: PackedObjects>(&mut self, s: S, maps: &RasterMaps<O>)
    where
        O::Blocks: Blocks<Many<S> = M>,
    {
        for (packet, (rays, best)) in self.rays.iter().zip(&mut self.best).enumerate() {
            if self.open[packet / Self::PACKETS] {
                maps.geometry.resolve_packet(s, rays, best);
            }
        }
    }

    /// Writes the hits to a row of tiles.
    #[inline(always)]
    fn end<O: PackedObjects>(&self, s: S, maps: &RasterMaps<O>, hits: &mut [Option<Hit>]) {
        let width = maps.raster.cols as usize;
        let left = (self.cols.start * THICKNESS) as usize;
        let right = width.min((self.cols.end * THICKNESS) as usize);
        for (row, hits) in hits.chunks_mut(THICKNESS as usize * width).enumerate() {
            if self.closed == self.rows.len() * self.cols.len() {
                hits.chunks_exact_mut(width).for_each(|line| miss(&mut line[left..right]));
                continue;
            }
            for col in 0..self.cols.len() {
                let cell = row * self.cols.len() + col;
                let from = left + col * THICKNESS as usize;
                let to = right.min(from + THICKNESS as usize);
                if !self.open[cell] {
                    hits.chunks_exact_mut(width).for_each(|line| miss(&mut line[from..to]));
                    continue;
                }
                let mut nearest = [Nearest::new(0.0); CELL];
                for (packet, nearest) in nearest.chunks_exact_mut(S::LANES).enumerate() {
                    self.best[cell * Self::PACKETS + packet].store(s, nearest);
                }
                let lines = hits.chunks_exact_mut(width).zip(nearest.as_chunks::<{ THICKNESS as usize }>().0);
                for (line, nearest) in lines {
                    let line = &mut line[from..to];
                    // Of a known length, so that no loop is left.
                    if let Ok(hits) = <&mut [_; THICKNESS as usize]>::try_from(&mut *line) {
                        hits.iter_mut().zip(nearest).for_each(|(hit, nearest)| *hit = nearest.hit());
                    } else {
                        line.iter_mut().zip(nearest).for_each(|(hit, nearest)| *hit = nearest.hit());
                    }
                }
            }
        }
    }
}

/// Writes that nothing is hit. Copied, because single marks that are far from each other take longer to write than whole lines.
fn miss(hits: &mut [Option<Hit>]) {
    static NONE: [Option<Hit>; 32] = [None; 32];
    for hits in hits.chunks_mut(NONE.len()) {
        hits.copy_from_slice(&NONE[..hits.len()]);
    }
}
