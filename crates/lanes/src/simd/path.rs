//! Bit maps along a straight path: the one operation on words that instruction sets do differently.

use crate::row::Row;
use accel::tolerance::TRIM;

/// Slices of each map.
pub const SLICES: usize = 8;

/// The axis on which something of this size is longest, the first of several. Looked up rather than branched on: which it is can't
/// be foreseen.
#[inline(always)]
pub fn dominant_axis(size: [f32; 3]) -> usize {
    let axis = usize::from(size[1] > size[0]);
    if size[2] > size[axis] { 2 } else { axis }
}

/// The two axes after one, going round.
#[inline(always)]
pub fn following(axis: usize) -> [usize; 2] {
    [[1, 2, 0][axis], [2, 0, 1][axis]]
}

/// A path through three maps of [`SLICES`] slices of unit thickness, along the axis on which it is longest. On that
/// axis it rises from `low` to `high`; on each of the other two it starts at `start`
/// and moves by `slope`, at most 1 either way, for each slice of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// Where it begins on the long axis.
    pub low: f32,
    /// Where it ends on the long axis.
    pub high: f32,
    /// Where it begins on the other axes.
    pub start: [f32; 2],
    /// How it moves on the other axes.
    pub slope: [f32; 2],
}

/// Paths side by side: `low`, `high`, both of `start` and both of `slope`.
#[derive(Clone, Copy, Debug)]
pub struct PathRows(pub [Row; 6]);

impl PathRows {
    /// One of them.
    #[inline(always)]
    pub fn path(&self, lane: usize) -> Path {
        let [low, high, b, c, slope_b, slope_c] = self.0.each_ref().map(|row| row.0[lane]);
        Path { low, high, start: [b, c], slope: [slope_b, slope_c] }
    }
}

/// What contains paths through three maps of [`SLICES`] slices of unit thickness. Along one axis it reaches from `low` to `high`; on each
/// of the other two, at a place between, from one straight line to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull {
    /// Where it begins on the first axis.
    pub low: f32,
    /// Where it ends on the first axis, beyond `low`.
    pub high: f32,
    /// For each of the other axes the lower and the upper line: where it is at `low`, and how it moves for each slice of the first axis.
    pub sides: [[[f32; 2]; 2]; 2],
}

/// Union over the slices of the first axis of its word & (all words that the hull touches on the second) & (those on the third).
#[inline(always)]
pub(super) fn hull_union(maps: [&[u64; SLICES]; 3], hull: &Hull) -> u64 {
    let mut union = 0;
    for (slice, word) in maps[0].iter().enumerate() {
        let (begin, end) = (slice as f32, slice as f32 + 1.0);
        if end <= hull.low || begin > hull.high {
            continue;
        }
        let (left, right) = (begin.max(hull.low) - hull.low, end.min(hull.high) - hull.low);
        let [a, b] = [0, 1];
        union |= word
            & within(maps[1], &hull.sides[a], left, right)
            & within(maps[2], &hull.sides[b], left, right);
    }
    union
}

/// The words between two lines, from one place to another.
#[inline(always)]
fn within(map: &[u64; SLICES], [low, high]: &[[f32; 2]; 2], left: f32, right: f32) -> u64 {
    let near = (low[0] + low[1] * left).min(low[0] + low[1] * right);
    let far = (high[0] + high[1] * left).max(high[0] + high[1] * right);
    if far < -BESIDE || near > SLICES as f32 + BESIDE {
        return 0;
    }
    let (first, last) = (clamped(near), clamped(far));
    map[first..=last.max(first)].iter().fold(0, |union, word| union | word)
}

/// What is so many slices or more beside the maps meets none of their objects, rounding included.
pub(super) const BESIDE: f32 = 1.0;

/// Union over the slices of the long axis of its word & (the at most two words touched on
/// the second axis) & (those on the third).
#[inline(always)]
pub(super) fn union(maps: [&[u64; SLICES]; 3], path: &Path) -> u64 {
    let first = clamped(path.low);
    let last = clamped(path.high);
    // Steps as bits and no counter: compilers turn a counted loop of so few steps into gathers.
    let mut steps = (2u32 << last) - (1 << first);
    let mut union = 0;
    while steps != 0 {
        let slice = steps.trailing_zeros() as usize & (SLICES - 1);
        steps &= steps - 1;
        let left = (slice as f32).max(path.low) - path.low;
        let right = (slice as f32 + 1.0).min(path.high) - path.low;
        let [a, b] = [0, 1];
        union |= maps[0][slice]
            & touched(maps[1], path.start[a] + path.slope[a] * left, path.start[a] + path.slope[a] * right)
            & touched(maps[2], path.start[b] + path.slope[b] * left, path.start[b] + path.slope[b] * right);
    }
    union
}

#[inline(always)]
fn touched(map: &[u64; SLICES], p: f32, q: f32) -> u64 {
    let (near, far) = if p < q { (p, q) } else { (q, p) };
    map[clamped(near)] | map[clamped(far - TRIM)]
}

/// The slice of a position, those outside counting to the nearest.
#[inline(always)]
fn clamped(position: f32) -> usize {
    (position.max(0.0) as usize).min(SLICES - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_axis_comes_first_and_the_others_follow() {
        for (size, axis, others) in [
            ([3.0, 2.0, 1.0], 0, [1, 2]),
            ([2.0, 3.0, 1.0], 1, [2, 0]),
            ([1.0, 2.0, 3.0], 2, [0, 1]),
            ([2.0, 2.0, 2.0], 0, [1, 2]),
            ([1.0, 2.0, 2.0], 1, [2, 0]),
        ] {
            assert_eq!((dominant_axis(size), following(axis)), (axis, others), "{size:?}");
        }
    }
}
