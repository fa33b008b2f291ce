//! Splits of items by a binned surface area heuristic (I. Wald, *On fast Construction of
//! SAH-based Bounding Volume Hierarchies*, IEEE Symposium on Interactive Ray Tracing, 2007).

use super::maps::UnitBox;

/// A box with the number of what is in it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Item {
    /// Least coordinates, and the number's bits, which no arithmetic touches.
    low: [f32; 4],
    /// Greatest coordinates with their signs changed, so that one minimum serves both ends.
    high: [f32; 4],
}

impl Item {
    /// A box in unit coordinates and its number.
    #[inline]
    pub fn new(number: u32, UnitBox { min, max }: &UnitBox) -> Self {
        Self { low: [min[0], min[1], min[2], f32::from_bits(number)], high: [-max[0], -max[1], -max[2], 0.0] }
    }

    /// The number.
    #[inline]
    pub fn number(&self) -> u32 {
        self.low[3].to_bits()
    }

    /// The box.
    #[inline]
    pub fn bounds(&self) -> UnitBox {
        boxed(&self.low, &self.high)
    }

    /// Twice the centre.
    #[inline]
    pub fn center(&self, axis: usize) -> f32 {
        self.low[axis] - self.high[axis]
    }
}

/// What splits weigh.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// True extents of the unit coordinates' axes, up to a common factor.
    pub extent: [f32; 3],
}

/// Bins of the sweep that looks for a split.
const BINS: usize = 16;

/// Up to this many packets of items a split leaves a multiple of the packet on its left.
const EXACT: usize = 64;

/// Either part holds at least this part of the items, so that the depth stays logarithmic.
const LEAST_PART: usize = 32;

impl Shape {
    /// Half the surface of a box.
    #[inline]
    pub fn area(&self, UnitBox { min, max }: &UnitBox) -> f32 {
        let x = (max[0] - min[0]) * self.extent[0];
        let y = (max[1] - min[1]) * self.extent[1];
        let z = (max[2] - min[2]) * self.extent[2];
        x * y + y * z + z * x
    }

    /// The box of all items.
    #[inline]
    pub fn bounds_of(&self, items: &[Item]) -> UnitBox {
        bounds_of(items)
    }

    /// The axis along which the items' box is longest in unit coordinates.
    pub fn longest_axis(items: &[Item]) -> usize {
        let UnitBox { min, max } = bounds_of(items);
        let [x, y, z] = [max[0] - min[0], max[1] - min[1], max[2] - min[2]];
        if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        }
    }

    /// Reorders the items into two parts, neither empty, and returns the first part's length. Costs count packets of `packet` items, and
    /// where there are few of them the first part is a whole number of packets.
    ///
    /// # Panics
    /// If there are fewer than two items, or no more than a packet.
    pub fn divide(&self, items: &mut [Item], packet: usize) -> usize {
        let len = items.len();
        assert!(len > packet.max(1), "nothing to divide");
        let whole =
            |left: usize| ((left + packet / 2) / packet * packet).clamp(packet, (len - 1) / packet * packet);
        let Some((axis, bin, bins)) = self.best_bin(items, packet) else {
            return whole(len / 2);
        };
        let left = partition(items, |item| bins.of(item, axis) < bin);
        // A cut that takes off very little makes no progress worth its pass over all items.
        let wanted = whole(left.clamp(len / LEAST_PART, len - len / LEAST_PART));
        let even_enough = left.min(len - left) >= len / LEAST_PART;
        if even_enough && (packet == 1 || len > EXACT * packet) {
            return left;
        }
        // A few items more on one side: those whose centres come next.
        let nearer = |a: &Item, b: &Item| a.center(axis).total_cmp(&b.center(axis));
        if wanted < left {
            items[..left].select_nth_unstable_by(wanted, nearer);
        } else if wanted > left {
            items[left..].select_nth_unstable_by(wanted - left, nearer);
        }
        wanted
    }

    /// The axis and the bin before which to split; `None` where all centres coincide.
    fn best_bin(&self, items: &[Item], packet: usize) -> Option<(usize, usize, Bins)> {
        let bins = Bins::new(items)?;
        let mut low = [[[f32::INFINITY; 4]; BINS]; 3];
        let mut high = [[[f32::INFINITY; 4]; BINS]; 3];
        let mut count = [[0u32; BINS]; 3];
        for item in items {
            for axis in 0..3 {
                let bin = bins.of(item, axis);
                count[axis][bin] += 1;
                lower(&mut low[axis][bin], &item.low);
                lower(&mut high[axis][bin], &item.high);
            }
        }
        // In quarters of packets, so that splits within a few packets tell apart.
        let quarter = packet.div_ceil(4) as u32;
        let cost = |bounds: &UnitBox, n: u32| {
            if n == 0 { 0.0 } else { self.area(bounds) * n.div_ceil(quarter) as f32 }
        };
        let mut best = (f32::INFINITY, 0, 0);
        for axis in (0..3).filter(|axis| bins.scale[*axis] > 0.0) {
            let mut right_cost = [0.0; BINS];
            let (mut bounds, mut n) = (UnitBox::EMPTY, 0);
            for bin in (1..BINS).rev() {
                bounds = bounds.union(&boxed(&low[axis][bin], &high[axis][bin]));
                n += count[axis][bin];
                right_cost[bin] = cost(&bounds, n);
            }
            let (mut bounds, mut n) = (UnitBox::EMPTY, 0);
            for bin in 1..BINS {
                bounds = bounds.union(&boxed(&low[axis][bin - 1], &high[axis][bin - 1]));
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
fn boxed(low: &[f32; 4], high: &[f32; 4]) -> UnitBox {
    UnitBox { min: [low[0], low[1], low[2]], max: [-high[0], -high[1], -high[2]] }
}

#[inline(always)]
fn lower(into: &mut [f32; 4], from: &[f32; 4]) {
    for (into, from) in into.iter_mut().zip(from) {
        *into = if *from < *into { *from } else { *into };
    }
}

fn bounds_of(items: &[Item]) -> UnitBox {
    let (mut low, mut high) = ([f32::INFINITY; 4], [f32::INFINITY; 4]);
    for item in items {
        lower(&mut low, &item.low);
        lower(&mut high, &item.high);
    }
    boxed(&low, &high)
}

/// Bins of equal width over the range of centres.
struct Bins {
    from: [f32; 3],
    scale: [f32; 3],
}

impl Bins {
    fn new(items: &[Item]) -> Option<Self> {
        let (mut low, mut high) = ([f32::INFINITY; 4], [f32::INFINITY; 4]);
        for item in items {
            let [lo, hi] = [&item.low, &item.high];
            lower(&mut low, &[lo[0] - hi[0], lo[1] - hi[1], lo[2] - hi[2], 0.0]);
            lower(&mut high, &[hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2], 0.0]);
        }
        let mut scale = [0.0; 3];
        for axis in 0..3 {
            let width = -high[axis] - low[axis];
            if width > 1e-7 {
                scale[axis] = BINS as f32 * 0.999_99 / width;
            }
        }
        (scale != [0.0; 3]).then_some(Self { from: [low[0], low[1], low[2]], scale })
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
