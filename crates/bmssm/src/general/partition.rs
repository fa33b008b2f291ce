//! The order of objects: a binary tree of splits whose leaves are the blocks.

use super::maps::UnitBox;
use accel::objects::BLOCK;

/// An object's box with its number.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Item {
    /// Least coordinates, and a lane that carries nothing.
    low: [f32; 4],
    /// Greatest coordinates with their signs changed, so that one minimum serves both ends.
    high: [f32; 3],
    /// The object's number.
    pub object: u32,
}

impl Item {
    /// An object's box in unit coordinates.
    pub fn new(object: u32, UnitBox { min, max }: UnitBox) -> Self {
        Self { low: [min[0], min[1], min[2], 0.0], high: max.map(|v| -v), object }
    }

    /// The object's box.
    #[inline]
    pub fn bounds(&self) -> UnitBox {
        UnitBox { min: [self.low[0], self.low[1], self.low[2]], max: self.high.map(|v| -v) }
    }

    /// Twice the centre.
    #[inline]
    fn center(&self, axis: usize) -> f32 {
        self.low[axis] - self.high[axis]
    }
}

/// A binary tree over consecutive items.
#[derive(Clone, Debug)]
pub struct Split {
    /// The box of all items.
    pub bounds: UnitBox,
    /// Number of blocks below.
    pub blocks: u32,
    /// First item.
    pub first: usize,
    /// Number of items.
    pub len: usize,
    /// The two halves; `None` for a block.
    pub halves: Option<Box<[Split; 2]>>,
}

/// Bins of the sweep that looks for a split.
const BINS: usize = 16;

/// Up to this many items a split leaves a multiple of [`BLOCK`] on its left, so that blocks are full.
const EXACT: usize = 64 * BLOCK;

/// From this many items on the two halves are split by two threads.
const PARALLEL: usize = 1 << 13;

/// What the splits weigh.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// True extents of the unit coordinates' axes, up to a common factor.
    pub extent: [f32; 3],
}

impl Shape {
    /// Half the surface of a box.
    #[inline]
    fn area(&self, UnitBox { min, max }: &UnitBox) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|a| (max[a] - min[a]) * self.extent[a]);
        x * y + y * z + z * x
    }

    /// Orders the items and returns the tree of splits.
    pub fn split(&self, items: &mut [Item], first: usize) -> Split {
        let bounds = bounds_of(items);
        if items.len() <= BLOCK {
            arrange(items);
            return Split { bounds, blocks: 1, first, len: items.len(), halves: None };
        }
        let at = self.divide(items);
        let len = items.len();
        let (left, right) = items.split_at_mut(at);
        let halves = if len >= PARALLEL {
            rayon::join(|| self.split(left, first), || self.split(right, first + at))
        } else {
            (self.split(left, first), self.split(right, first + at))
        };
        let blocks = halves.0.blocks + halves.1.blocks;
        Split { bounds, blocks, first, len, halves: Some(Box::new([halves.0, halves.1])) }
    }

    /// Reorders the items into two parts by a binned surface area heuristic over blocks and returns the first part's length
    /// (I. Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies*, 2007).
    fn divide(&self, items: &mut [Item]) -> usize {
        let len = items.len();
        let middle = (len / 2).next_multiple_of(BLOCK).min(len - 1);
        let Some((axis, bin, bins)) = self.best_bin(items) else {
            return middle;
        };
        if len > EXACT {
            return partition(items, |item| bins.of(item, axis) < bin);
        }
        let left = items.iter().filter(|item| bins.of(item, axis) < bin).count();
        let left = ((left + BLOCK / 2) / BLOCK * BLOCK).clamp(BLOCK, (len - 1) / BLOCK * BLOCK);
        items.select_nth_unstable_by(left, |a, b| a.center(axis).total_cmp(&b.center(axis)));
        left
    }

    /// The axis and the bin before which to split; `None` where all centres coincide.
    fn best_bin(&self, items: &[Item]) -> Option<(usize, usize, Bins)> {
        let bins = Bins::new(items)?;
        let mut low = [[[f32::INFINITY; 4]; BINS]; 3];
        let mut high = [[[f32::INFINITY; 4]; BINS]; 3];
        let mut count = [[0u32; BINS]; 3];
        for item in items {
            let high_of = [item.high[0], item.high[1], item.high[2], 0.0];
            for axis in 0..3 {
                let bin = bins.of(item, axis);
                count[axis][bin] += 1;
                lower(&mut low[axis][bin], &item.low);
                lower(&mut high[axis][bin], &high_of);
            }
        }
        let mut best = (f32::INFINITY, 0, 0);
        for axis in (0..3).filter(|axis| bins.scale[*axis] > 0.0) {
            let boxed = |bin: usize| UnitBox {
                min: std::array::from_fn(|a| low[axis][bin][a]),
                max: std::array::from_fn(|a| -high[axis][bin][a]),
            };
            let cost = |bounds: &UnitBox, n: u32| {
                if n == 0 { 0.0 } else { self.area(bounds) * n.div_ceil(BLOCK as u32 / 4) as f32 }
            };
            let mut right_cost = [0.0; BINS];
            let (mut bounds, mut n) = (UnitBox::EMPTY, 0);
            for bin in (1..BINS).rev() {
                bounds = bounds.union(&boxed(bin));
                n += count[axis][bin];
                right_cost[bin] = cost(&bounds, n);
            }
            let (mut bounds, mut n) = (UnitBox::EMPTY, 0);
            for bin in 1..BINS {
                bounds = bounds.union(&boxed(bin - 1));
                n += count[axis][bin - 1];
                let total = cost(&bounds, n) + right_cost[bin];
                if n > 0 && (n as usize) < items.len() && total < best.0 {
                    best = (total, axis, bin);
                }
            }
        }
        (best.0 < f32::INFINITY).then_some((best.1, best.2, bins))
    }
}

#[inline(always)]
fn lower(into: &mut [f32; 4], from: &[f32; 4]) {
    for (into, from) in into.iter_mut().zip(from) {
        *into = if *from < *into { *from } else { *into };
    }
}

/// The box of all items.
pub fn bounds_of(items: &[Item]) -> UnitBox {
    let (mut low, mut high) = ([f32::INFINITY; 4], [f32::INFINITY; 4]);
    for item in items {
        lower(&mut low, &item.low);
        lower(&mut high, &[item.high[0], item.high[1], item.high[2], 0.0]);
    }
    UnitBox { min: [low[0], low[1], low[2]], max: [-high[0], -high[1], -high[2]] }
}

/// Bins of equal width over the range of centres.
struct Bins {
    from: [f32; 3],
    scale: [f32; 3],
}

impl Bins {
    fn new(items: &[Item]) -> Option<Self> {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for item in items {
            for axis in 0..3 {
                let center = item.center(axis);
                low[axis] = if center < low[axis] { center } else { low[axis] };
                high[axis] = if center > high[axis] { center } else { high[axis] };
            }
        }
        let scale = [0, 1, 2].map(|a: usize| {
            let width = high[a] - low[a];
            if width > 1e-7 { BINS as f32 * 0.999_99 / width } else { 0.0 }
        });
        (scale != [0.0; 3]).then_some(Self { from: low, scale })
    }

    #[inline(always)]
    fn of(&self, item: &Item, axis: usize) -> usize {
        (((item.center(axis) - self.from[axis]) * self.scale[axis]) as usize).min(BINS - 1)
    }
}

/// Moves the items that belong left to the front and returns their number.
fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> usize {
    let (mut i, mut j) = (0, items.len());
    loop {
        while i < j && is_left(&items[i]) {
            i += 1;
        }
        while i < j && !is_left(&items[j - 1]) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        items.swap(i, j - 1);
    }
}

/// Orders the items of a block so that neighbours in space share groups of 16.
fn arrange(items: &mut [Item]) {
    let len = items.len();
    if len <= 16 {
        return;
    }
    let half = if len > 32 { 32 } else { 16 };
    let bounds = bounds_of(items);
    let axis = (0..3)
        .max_by(|a, b| (bounds.max[*a] - bounds.min[*a]).total_cmp(&(bounds.max[*b] - bounds.min[*b])))
        .unwrap_or(0);
    items.select_nth_unstable_by(half, |a, b| a.center(axis).total_cmp(&b.center(axis)));
    let (left, right) = items.split_at_mut(half);
    arrange(left);
    arrange(right);
}
