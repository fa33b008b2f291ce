//! Splits of items across the axis on which they range farthest, by a binned surface area heuristic (I. Wald, *On fast Construction of
//! SAH-based Bounding Volume Hierarchies*, IEEE Symposium on Interactive Ray Tracing, 2007).

mod item;
mod unit_box;

pub use item::{Extremes, Item, whole};
pub use unit_box::UnitBox;

use crate::{Simd, Task};

/// What splits weigh.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// True extents of the unit coordinates' axes, up to a common factor.
    pub extent: [f32; 3],
}

/// What a split leaves on its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// Any number of items.
    Any,
    /// Any number, but the cost of a part counts its weight in packets of so many.
    Packed(usize),
    /// A whole number of packets of so many items; each item weighs 1.
    Whole(usize),
}

/// Bins of the sweep that looks for a split.
const BINS: usize = 16;

/// Bins in which items are marked, as many in each of [`BINS`].
const FINE: usize = 64;

/// Either part holds at least this part of the items, so that the depth stays logarithmic.
const MIN_PART: usize = 32;

/// A split is looked for among about so many items; among more, the best split changes little.
const SAMPLE: usize = 128;

/// What a division overwrites.
pub struct Scratch<'a> {
    /// Room for as many items.
    pub items: &'a mut [Item],
    /// A byte for each.
    pub marks: &'a mut [u8],
}

impl Scratch<'_> {
    /// That of so many items, which it has no more.
    ///
    /// # Panics
    /// If it has less.
    pub fn take(&mut self, items: usize) -> Self {
        let marks = self.marks.split_off_mut(..items).expect("a mark for each");
        Self { items: self.items.split_off_mut(..items).expect("room for all"), marks }
    }
}

impl Shape {
    /// Half the surface of a box.
    #[inline(always)]
    pub fn area(&self, UnitBox { min, max }: &UnitBox) -> f32 {
        let x = (max[0] - min[0]) * self.extent[0];
        let y = (max[1] - min[1]) * self.extent[1];
        let z = (max[2] - min[2]) * self.extent[2];
        x * y + y * z + z * x
    }

    /// Reorders the items into two parts, neither empty, and returns the first part's length. Within a
    /// part the items stay in order. They are then in `scratch.items`.
    ///
    /// # Panics
    /// If there are fewer than two items, no more than a packet, or less scratch than items.
    #[inline(always)]
    pub fn divide(&self, items: &[Item], scratch: &mut Scratch, left: Left) -> usize {
        let len = items.len();
        let packet = match left {
            Left::Whole(packet) => packet,
            Left::Any | Left::Packed(_) => 1,
        };
        assert!(len > packet.max(1), "nothing to divide");
        let even = |left: usize| {
            let left = left.clamp(len / MIN_PART, len - len / MIN_PART);
            ((left + packet / 2) / packet * packet).clamp(packet, (len - 1) / packet * packet)
        };
        let stride = (len / SAMPLE).max(1);
        let Some(bins) = self.bins(items, stride) else {
            scratch.items[..len].copy_from_slice(items);
            return even(len / 2);
        };
        let marks = &mut scratch.marks[..len];
        let counts = bins.mark(items, marks);
        let wanted = if packet > 1 && len <= 2 * packet {
            packet
        } else {
            match self.best_bin(items, marks, stride, left) {
                Some(bin) => even(counts[..bin * (FINE / BINS)].iter().sum::<u32>() as usize),
                None => even(len / 2),
            }
        };
        partition(items, &mut scratch.items[..len], marks, &counts, wanted);
        wanted
    }

    /// Bins over the axis on which the centres of every `stride`th item truly range farthest; `None` where they
    /// coincide.
    #[inline(always)]
    fn bins(&self, items: &[Item], stride: usize) -> Option<Bins> {
        let mut all = Extremes::NONE;
        for item in items.iter().step_by(stride) {
            all.gather(&item.centers());
        }
        let UnitBox { min, max } = all.bounds();
        let width = |axis: usize| (max[axis] - min[axis]) * self.extent[axis];
        let axis = usize::from(width(1) > width(0));
        let axis = if width(2) > width(axis) { 2 } else { axis };
        let width = max[axis] - min[axis];
        (width > 1e-7).then(|| Bins { axis, from: min[axis], scale: (FINE - 1) as f32 / width })
    }

    /// The bin before which to split; `None` where all items looked at are in one bin.
    #[inline(always)]
    fn best_bin(&self, items: &[Item], marks: &[u8], stride: usize, left: Left) -> Option<usize> {
        // Items take turns between two sets, as neighbours tend to share a bin and would wait for each other.
        let mut ranges = [[Extremes::NONE; BINS]; 2];
        let mut weights = [[0u32; BINS]; 2];
        for (i, (item, mark)) in items.iter().zip(marks).step_by(stride).enumerate() {
            let bin = (usize::from(*mark) / (FINE / BINS)) & (BINS - 1);
            weights[i & 1][bin] += item.weight();
            ranges[i & 1][bin].gather(&item.extremes());
        }
        let [mut ranges, others] = ranges;
        let [mut weights, other_weights] = weights;
        for bin in 0..BINS {
            ranges[bin].gather(&others[bin]);
            weights[bin] = (weights[bin] + other_weights[bin]) * stride as u32;
        }
        // In quarters of packets, so that splits within a few packets tell apart.
        let quarter = match left {
            Left::Any => 1,
            Left::Packed(packet) | Left::Whole(packet) => packet.div_ceil(4) as u32,
        };
        let cost = |range: &Extremes, weight: u32| {
            if weight == 0 { 0.0 } else { self.area(&range.bounds()) * weight.div_ceil(quarter) as f32 }
        };
        let mut right = [(0.0, 0); BINS];
        let (mut range, mut weight) = (Extremes::NONE, 0);
        for bin in (1..BINS).rev() {
            range.gather(&ranges[bin]);
            weight += weights[bin];
            right[bin] = (cost(&range, weight), weight);
        }
        let mut best = (f32::INFINITY, 0);
        let (mut range, mut weight) = (Extremes::NONE, 0);
        for bin in 1..BINS {
            range.gather(&ranges[bin - 1]);
            weight += weights[bin - 1];
            let total = cost(&range, weight) + right[bin].0;
            if weight > 0 && right[bin].1 > 0 && total < best.0 {
                best = (total, bin);
            }
        }
        (best.0 < f32::INFINITY).then_some(best.1)
    }
}

/// [`Shape::divide`] in place and at an instruction set.
pub struct Divide<'a, 'b> {
    /// What splits weigh.
    pub shape: &'a Shape,
    /// The items, before and after.
    pub items: &'a mut [Item],
    /// As there.
    pub scratch: &'a mut Scratch<'b>,
    /// As there.
    pub left: Left,
}

impl Task for Divide<'_, '_> {
    type Out = usize;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> usize {
        let at = self.shape.divide(self.items, self.scratch, self.left);
        self.items.copy_from_slice(&self.scratch.items[..self.items.len()]);
        at
    }
}

/// Bins of equal width over the range of centres on an axis.
struct Bins {
    axis: usize,
    from: f32,
    /// Bins per unit.
    scale: f32,
}

impl Bins {
    /// Marks each item with its bin, the outermost for those beyond, and counts them.
    #[inline(always)]
    fn mark(&self, items: &[Item], marks: &mut [u8]) -> [u32; FINE] {
        let last = (FINE - 1) as f32;
        let mut counts = [[0u32; FINE]; 2];
        for (i, (item, mark)) in items.iter().zip(marks).enumerate() {
            let place = (item.center(self.axis) - self.from) * self.scale;
            let place = if place > 0.0 { place } else { 0.0 };
            let bin = whole(if place < last { place } else { last }) as usize & (FINE - 1);
            *mark = bin as u8;
            counts[i & 1][bin] += 1;
        }
        let [mut counts, others] = counts;
        counts.iter_mut().zip(others).for_each(|(count, other)| *count += other);
        counts
    }
}

/// Copies the items so that the first `left` in the order of marks are at the front, both parts in the order they
/// were; `counts` are those of the marks.
#[inline(always)]
fn partition(items: &[Item], out: &mut [Item], marks: &[u8], counts: &[u32; FINE], left: usize) {
    let (mut cut, mut rest) = (0, left as u32);
    while cut < FINE - 1 && counts[cut] <= rest {
        rest -= counts[cut];
        cut += 1;
    }
    let (len, cut) = (items.len(), cut as u8);
    // Of the bin that is cut, the items before `stop` belong left.
    let mut stop = 0;
    while rest > 0 {
        rest -= u32::from(marks[stop] == cut);
        stop += 1;
    }
    let mut next = [left, 0];
    for (range, end) in [(0..stop, cut + 1), (stop..len, cut)] {
        for (item, mark) in items[range.clone()].iter().zip(&marks[range]) {
            // Looked up rather than branched on: which side it is can't be foreseen.
            let next = &mut next[usize::from(*mark < end)];
            out[*next] = *item;
            *next += 1;
        }
    }
}
