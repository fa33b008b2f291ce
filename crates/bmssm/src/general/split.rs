//! Splits of items across the axis on which they range farthest, by a binned surface area heuristic (I. Wald, *On fast Construction of
//! SAH-based Bounding Volume Hierarchies*, IEEE Symposium on Interactive Ray Tracing, 2007).

use super::item::{Extremes, Item, whole};
use super::maps::UnitBox;
use accel::simd::{Simd, Task};

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

/// Either part holds at least this part of the items, so that the depth stays logarithmic.
const LEAST_PART: usize = 32;

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
    /// part the items stay in order. `scratch` is overwritten.
    ///
    /// # Panics
    /// If there are fewer than two items, no more than a packet, or less scratch than items.
    #[inline(always)]
    pub fn divide(&self, items: &mut [Item], scratch: &mut [Item], left: Left) -> usize {
        let len = items.len();
        let packet = match left {
            Left::Whole(packet) => packet,
            Left::Any | Left::Packed(_) => 1,
        };
        assert!(len > packet.max(1), "nothing to divide");
        let even = |left: usize| {
            let left = left.clamp(len / LEAST_PART, len - len / LEAST_PART);
            ((left + packet / 2) / packet * packet).clamp(packet, (len - 1) / packet * packet)
        };
        let Some(bins) = Bins::new(items) else {
            return even(len / 2);
        };
        let axis = self.widest(&bins);
        if len <= 2 * packet && packet > 1 {
            return bins.part(items, scratch, axis, packet);
        }
        let Some((bin, count)) = self.best_bin(&bins, axis, items, left) else {
            return even(len / 2);
        };
        let wanted = even(count);
        if wanted == count {
            return partition(items, scratch, |item| bins.of(item, axis) < bin);
        }
        bins.part(items, scratch, axis, wanted)
    }

    /// The axis on which the centres truly range farthest.
    #[inline(always)]
    fn widest(&self, bins: &Bins) -> usize {
        let width = |axis: usize| bins.width[axis] * self.extent[axis];
        let axis = usize::from(width(1) > width(0));
        if width(2) > width(axis) { 2 } else { axis }
    }

    /// The bin of this axis before which to split, and the number of items before it; `None` where all
    /// are in one bin.
    #[inline(always)]
    fn best_bin(&self, bins: &Bins, axis: usize, items: &[Item], left: Left) -> Option<(usize, usize)> {
        let mut ranges = [Extremes::NONE; BINS];
        let mut counts = [[0u32; 2]; BINS];
        for item in items {
            let bin = bins.of(item, axis) & (BINS - 1);
            let [count, weight] = &mut counts[bin];
            *count += 1;
            *weight += item.weight();
            ranges[bin].gather(&item.extremes());
        }
        // In quarters of packets, so that splits within a few packets tell apart.
        let quarter = match left {
            Left::Any => 1,
            Left::Packed(packet) | Left::Whole(packet) => packet.div_ceil(4) as u32,
        };
        let cost = |range: &Extremes, weight: u32| {
            if weight == 0 { 0.0 } else { self.area(&range.bounds()) * weight.div_ceil(quarter) as f32 }
        };
        let mut right_cost = [0.0; BINS];
        let (mut range, mut weight) = (Extremes::NONE, 0);
        for bin in (1..BINS).rev() {
            range.gather(&ranges[bin]);
            weight += counts[bin][1];
            right_cost[bin] = cost(&range, weight);
        }
        let mut best = (f32::INFINITY, 0, 0);
        let (mut range, mut count, mut weight) = (Extremes::NONE, 0, 0);
        for bin in 1..BINS {
            range.gather(&ranges[bin - 1]);
            count += counts[bin - 1][0] as usize;
            weight += counts[bin - 1][1];
            let total = cost(&range, weight) + right_cost[bin];
            if count > 0 && count < items.len() && total < best.0 {
                best = (total, bin, count);
            }
        }
        (best.0 < f32::INFINITY).then_some((best.1, best.2))
    }
}

/// [`Shape::divide`] at an instruction set.
pub struct Divide<'a> {
    /// What splits weigh.
    pub shape: &'a Shape,
    /// As there.
    pub items: &'a mut [Item],
    /// As there.
    pub scratch: &'a mut [Item],
    /// As there.
    pub left: Left,
}

impl Task for Divide<'_> {
    type Out = usize;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> usize {
        self.shape.divide(self.items, self.scratch, self.left)
    }
}

/// Bins of equal width over the range of centres.
struct Bins {
    from: [f32; 3],
    width: [f32; 3],
    /// Bins per unit; 0 where all centres coincide.
    scale: [f32; 3],
}

/// Bins that look for the middle, of which a last one may be cut.
const FINE: usize = 64;

impl Bins {
    #[inline(always)]
    fn new(items: &[Item]) -> Option<Self> {
        let mut all = Extremes::NONE;
        for item in items {
            all.gather(&item.centers());
        }
        let UnitBox { min, max } = all.bounds();
        let (mut scale, mut width) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            width[axis] = max[axis] - min[axis];
            if width[axis] > 1e-7 {
                scale[axis] = (BINS - 1) as f32 / width[axis];
            }
        }
        (scale != [0.0; 3]).then_some(Self { from: min, width, scale })
    }

    #[inline(always)]
    fn of(&self, item: &Item, axis: usize) -> usize {
        whole((item.center(axis) - self.from[axis]) * self.scale[axis]) as usize & (BINS - 1)
    }

    /// Moves the first `left` items in the order of finer bins along an axis to the front, and returns
    /// `left`.
    #[inline(always)]
    fn part(&self, items: &mut [Item], scratch: &mut [Item], axis: usize, left: usize) -> usize {
        let (from, scale) = (self.from[axis], self.scale[axis] * ((FINE - 1) as f32 / (BINS - 1) as f32));
        let of = |item: &Item| whole((item.center(axis) - from) * scale) as usize & (FINE - 1);
        let mut counts = [0u32; FINE];
        for item in &*items {
            counts[of(item)] += 1;
        }
        let (mut cut, mut rest) = (0, left as u32);
        while cut < FINE - 1 && counts[cut] <= rest {
            rest -= counts[cut];
            cut += 1;
        }
        partition(items, scratch, |item| {
            let bin = of(item);
            let taken = bin == cut && rest > 0;
            rest -= u32::from(taken);
            bin < cut || taken
        })
    }
}

/// Moves the items that belong left to the front, both parts staying in order, and returns their number.
#[inline(always)]
fn partition(items: &mut [Item], scratch: &mut [Item], mut is_left: impl FnMut(&Item) -> bool) -> usize {
    let len = items.len();
    let scratch = &mut scratch[..len];
    let (mut left, mut right) = (0, 0);
    // Every item is written to both places, of which one is kept: no branch to mispredict.
    for i in 0..len {
        let item = items[i];
        let is_left = is_left(&item);
        items[left] = item;
        scratch[right] = item;
        left += usize::from(is_left);
        right += usize::from(!is_left);
    }
    items[left..].copy_from_slice(&scratch[..right]);
    left
}
