//! The binary maps of one block: a bit per object in each slice (Skala 1993, §2, §5).

use super::sides::Sides;
use accel::tolerance::LOCAL_MARGIN;
use lanes::Simd;
use lanes::path::{Hull, Path, PathRows, SLICES, dominant_axis, following};
use lanes::split::UnitBox;

/// The maps R, S and T of up to 64 objects in [`SLICES`] slices an axis, N of the paper, over the block's own box: the subdivision of space need not be
/// uniform (Skala 1993, abstract).
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub struct BlockMaps {
    /// `maps[0]` is R, `maps[1]` is S, `maps[2]` is T; one word for each slice.
    maps: [[u64; SLICES]; 3],
    /// Lower corner of the box.
    pub(super) origin: [f32; 3],
    /// Slices per unit of length.
    pub(super) density: [f32; 3],
}

impl BlockMaps {
    /// Of no objects.
    pub const EMPTY: Self = Self { maps: [[0; SLICES]; 3], origin: [0.0; 3], density: [0.0; 3] };

    /// Registers boxes by position; `bounds` contains them all.
    #[inline(always)]
    pub fn new<S: Simd>(s: S, bounds: &UnitBox, sides: &Sides) -> Self {
        let UnitBox { min: origin, max } = bounds.widened();
        let density = [0, 1, 2].map(|a| SLICES as f32 / (max[a] - origin[a]));
        let mut maps = Self { maps: [[0; SLICES]; 3], origin, density };
        let last = (SLICES - 1) as f32;
        for axis in 0..3 {
            for at in (0..sides.len).step_by(S::LANES) {
                let [first, end] = maps.spans(s, axis, sides, at);
                let first = s.min(first, s.splat(last));
                let end = s.max(end, s.splat(0.0));
                for (slice, word) in maps.maps[axis].iter_mut().enumerate() {
                    let begun = s.lt(first, s.splat((slice + 1) as f32));
                    let there = s.and(begun, s.le(s.splat(slice as f32), end));
                    *word |= u64::from(s.bits(there)) << at;
                }
            }
        }
        maps
    }

    /// Where boxes begin and end on an axis, in slices, widened by the margin of positions; `LANES` of them from a slot on.
    #[inline(always)]
    pub(super) fn spans<S: Simd>(&self, s: S, axis: usize, sides: &Sides, at: usize) -> [S::F; 2] {
        let (origin, density) = (s.splat(self.origin[axis]), s.splat(self.density[axis]));
        let margin = s.splat(LOCAL_MARGIN);
        let low = s.mul(s.sub(s.load(&sides.low[axis][at..]), origin), density);
        let high = s.mul(s.sub(s.load(&sides.high[axis][at..]), origin), density);
        [s.sub(low, margin), s.add(high, margin)]
    }

    /// The candidates of the straight way between two points of the scene's unit coordinates: the union of R & S & T over the cells
    /// that it passes.
    ///
    /// Along its dominant axis the way meets each slice once, and in that step at
    /// most two slices of each other axis, so a step's candidates are
    /// R & (S | S') & (T | T'), whichever axis is the dominant one.
    #[inline(always)]
    pub fn candidates<S: Simd>(&self, s: S, from: [f32; 3], to: [f32; 3]) -> u64 {
        let (from, to) = (self.local(from), self.local(to));
        let way = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let size = [way[0].abs(), way[1].abs(), way[2].abs()];
        let axis = dominant_axis(size);
        let [b, c] = following(axis);
        let begin = if way[axis] < 0.0 { to } else { from };
        let per_slice = if size[axis] > 0.0 { 1.0 / way[axis] } else { 0.0 };
        let path = Path {
            low: begin[axis],
            high: begin[axis] + size[axis],
            start: [begin[b], begin[c]],
            slope: [way[b] * per_slice, way[c] * per_slice],
        };
        s.path_union(self.starting_with(axis), &path)
    }

    /// The candidates of two of the paths, along each of which another axis may be the dominant one.
    #[inline(always)]
    pub(super) fn along_both<S: Simd>(
        &self,
        s: S,
        axes: [usize; 2],
        paths: &PathRows,
        lanes: [usize; 2],
    ) -> [u64; 2] {
        s.path_unions(axes.map(|axis| self.starting_with(axis)), paths, lanes)
    }

    /// The candidates within a hull that is described along `axis`.
    #[inline(always)]
    pub(super) fn within<S: Simd>(&self, s: S, axis: usize, hull: &Hull) -> u64 {
        s.hull_union(self.starting_with(axis), hull)
    }

    /// The maps in the order in which what is described along `axis` is held against them: that axis's, then those of the two
    /// that follow it.
    #[inline(always)]
    fn starting_with(&self, axis: usize) -> [&[u64; SLICES]; 3] {
        let [b, c] = following(axis);
        [&self.maps[axis], &self.maps[b], &self.maps[c]]
    }

    /// Two unit coordinates on an axis as the block's own.
    #[inline(always)]
    pub(super) fn local_pair(&self, axis: usize, [a, b]: [f32; 2]) -> [f32; 2] {
        let (origin, density) = (self.origin[axis], self.density[axis]);
        [(a - origin) * density, (b - origin) * density]
    }

    #[inline(always)]
    fn local(&self, p: [f32; 3]) -> [f32; 3] {
        [
            (p[0] - self.origin[0]) * self.density[0],
            (p[1] - self.origin[1]) * self.density[1],
            (p[2] - self.origin[2]) * self.density[2],
        ]
    }
}
