//! Divisions of few items into whole packets: all cuts on all axes are weighed by the boxes that they leave.

use super::item::{Extremes, Item};
use super::shape::Shape;
use crate::{ROW, Simd};

/// Most items that are divided so.
pub const FEW: usize = 256;

/// A bit for each item.
type Bits = [u64; FEW / 64];

/// Bisections until what is left to cut is cut in the order of items.
const STEPS: usize = 6;

/// Puts the items into two parts, of which the first holds a whole number of packets, and both keep their order. Answers how many that is.
///
/// # Panics
/// If there are more than [`FEW`] items, or no more than a packet.
#[inline(always)]
pub fn divide_few<S: Simd>(s: S, shape: &Shape, items: &[Item], out: &mut [Item], packet: usize) -> usize {
    assert!((packet + 1..=FEW).contains(&items.len()), "few items of more than a packet");
    let rows = Rows::of(s, items);
    let mut best = (f32::INFINITY, packet, Bits::default());
    for axis in 0..3 {
        for cut in (packet..items.len()).step_by(packet) {
            let first = rows.first(s, axis, cut);
            let [left, right] = rows.areas(s, shape, &first);
            let cost = left * cut as f32 + right * (items.len() - cut) as f32;
            if cost < best.0 || axis == 0 && cut == packet {
                best = (cost, cut, first);
            }
        }
    }
    let (_, cut, first) = best;
    let (mut place, mut at) = (0, 0);
    for (items, bits) in items.chunks(64).zip(first) {
        for (bit, item) in items.iter().enumerate() {
            let is_first = bits >> bit & 1 != 0;
            out[std::hint::select_unpredictable(is_first, place, cut + at - place)] = *item;
            place += usize::from(is_first);
            at += 1;
        }
    }
    cut
}

/// Items coordinate by coordinate; places without an item hold infinity.
struct Rows {
    /// How many there are, rounded up to whole rows.
    len: usize,
    /// A bit for each item.
    all: Bits,
    /// Least coordinates and greatest ones with their signs changed.
    ends: [[f32; FEW]; 6],
    /// Twice the centres.
    centers: [[f32; FEW]; 3],
    /// Their range on each axis.
    range: [[f32; 2]; 3],
}

impl Rows {
    #[inline(always)]
    fn of<S: Simd>(s: S, items: &[Item]) -> Self {
        let (len, infinity) = (items.len().next_multiple_of(ROW), s.splat(f32::INFINITY));
        let (mut ends, mut centers) = ([[0.0; FEW]; 6], [[0.0; FEW]; 3]);
        let (mut low, mut high) = ([infinity; 3], [s.splat(f32::NEG_INFINITY); 3]);
        for at in (0..len).step_by(S::LANES) {
            let (mut lows, mut highs) = ([&items[0].0.low; ROW], [&items[0].0.high; ROW]);
            for (lane, Item(Extremes { low, high })) in
                items[at.min(items.len())..].iter().take(S::LANES).enumerate()
            {
                (lows[lane], highs[lane]) = (low, high);
            }
            let there = items.len().saturating_sub(at).min(S::LANES);
            let there = s.mask((1u32 << there) - 1);
            let ([lx, ly, lz, _], [hx, hy, hz, _]) = (s.load_quads(&lows), s.load_quads(&highs));
            for (axis, (near, far)) in [(lx, hx), (ly, hy), (lz, hz)].into_iter().enumerate() {
                let center = s.sub(near, far);
                low[axis] = s.min(low[axis], center);
                high[axis] = s.max(high[axis], center);
                s.store(s.select(there, center, infinity), &mut centers[axis][at..]);
                s.store(s.select(there, near, infinity), &mut ends[axis][at..]);
                s.store(s.select(there, far, infinity), &mut ends[3 + axis][at..]);
            }
        }
        let range = [0, 1, 2].map(|axis| [s.least(low[axis]), s.most(high[axis])]);
        let mut all = Bits::default();
        for (word, items) in all.iter_mut().zip(items.chunks(64)) {
            *word = u64::MAX >> (64 - items.len());
        }
        Self { len, all, ends, centers, range }
    }

    /// So many of the items, those with the least centres on an axis, up to fine differences.
    #[inline(always)]
    fn first<S: Simd>(&self, s: S, axis: usize, count: usize) -> Bits {
        let [mut low, mut high] = self.range[axis];
        let (mut first, mut missing, mut upper) = (Bits::default(), count, self.all);
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            let below = self.below(s, axis, middle);
            let found = below.iter().map(|word| word.count_ones() as usize).sum::<usize>();
            if found > count {
                (high, upper) = (middle, below);
                continue;
            }
            (low, first, missing) = (middle, below, count - found);
            if missing == 0 {
                break;
            }
        }
        for (first, upper) in first.iter_mut().zip(upper) {
            let mut left = upper & !*first;
            while missing > 0 && left != 0 {
                *first |= left & left.wrapping_neg();
                left &= left - 1;
                missing -= 1;
            }
        }
        first
    }

    /// The items whose centres are below a place on an axis.
    #[inline(always)]
    fn below<S: Simd>(&self, s: S, axis: usize, place: f32) -> Bits {
        let (mut below, place) = (Bits::default(), s.splat(place));
        for at in (0..self.len).step_by(S::LANES) {
            let bits = s.bits(s.lt(s.load(&self.centers[axis][at..]), place));
            below[at / 64] |= u64::from(bits) << (at % 64);
        }
        below
    }

    /// The surfaces of the boxes of the items that are chosen and of the others.
    #[inline(always)]
    fn areas<S: Simd>(&self, s: S, shape: &Shape, chosen: &Bits) -> [f32; 2] {
        let infinity = s.splat(f32::INFINITY);
        let mut ends = [[infinity; 6]; 2];
        for at in (0..self.len).step_by(S::LANES) {
            let chosen = s.mask((chosen[at / 64] >> (at % 64)) as u32);
            for (row, from) in self.ends.iter().enumerate() {
                let value = s.load(&from[at..]);
                ends[0][row] = s.min(ends[0][row], s.select(chosen, value, infinity));
                ends[1][row] = s.min(ends[1][row], s.select(chosen, infinity, value));
            }
        }
        ends.map(|ends| {
            let [lx, ly, lz, hx, hy, hz] = ends.map(|end| s.least(end));
            shape.area(&Extremes { low: [lx, ly, lz, 0.0], high: [hx, hy, hz, 0.0] }.bounds())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::UnitBox;
    use super::*;
    use crate::{Level, Task};
    use proptest::prelude::*;

    struct Divided<'a>(&'a [Item], usize);

    impl Task for Divided<'_> {
        type Out = (usize, Vec<Item>);

        fn run<S: Simd>(self, s: S) -> Self::Out {
            let Self(items, packet) = self;
            let mut out = vec![Item::EMPTY; items.len()];
            (divide_few(s, &SHAPE, items, &mut out, packet), out)
        }
    }

    const SHAPE: Shape = Shape { extent: [1.0, 0.5, 0.75] };

    /// What two parts cost.
    fn cost(items: &[Item], cut: usize) -> f32 {
        let (left, right) = items.split_at(cut);
        let part = |items: &[Item]| SHAPE.area(&Extremes::of(items).bounds()) * items.len() as f32;
        part(left) + part(right)
    }

    /// Which of the finest parts of a range holds a centre.
    fn bisected([mut low, mut high]: [f32; 2], center: f32) -> usize {
        (0..STEPS).fold(0, |part, _| {
            let middle = 0.5 * (low + high);
            *if center < middle { &mut high } else { &mut low } = middle;
            2 * part + usize::from(center >= middle)
        })
    }

    fn numbers(items: &[Item]) -> Vec<u32> {
        items.iter().map(Item::number).collect()
    }

    /// Boxes of many sizes on a grid of so many steps: coarse ones share their centres.
    fn boxes() -> impl Strategy<Value = Vec<Item>> {
        let at = |steps: u32| prop::array::uniform3(0..steps);
        let size = prop::array::uniform3(0u32..12);
        (prop::sample::select(vec![2u32, 9, 1 << 20]), 65usize..=FEW).prop_flat_map(move |(steps, len)| {
            prop::collection::vec((at(steps), size.clone()), len).prop_map(move |boxes| {
                let item = |(number, (at, size)): (usize, ([u32; 3], [u32; 3]))| {
                    let min = at.map(|at| at as f32 / steps as f32);
                    let max = std::array::from_fn(|axis| {
                        min[axis] + 0.5f32.powi(size[axis] as i32) - 0.5f32.powi(11)
                    });
                    Item::new(number as u32, 1, &UnitBox { min, max })
                };
                boxes.into_iter().enumerate().map(item).collect()
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn no_cut_is_cheaper(items in boxes()) {
            let packet = 64;
            let (cut, divided) = Level::Portable.run(Divided(&items, packet));
            prop_assert!(cut > 0 && cut < items.len() && cut % packet == 0);
            for part in [&divided[..cut], &divided[cut..]] {
                prop_assert!(part.is_sorted_by_key(Item::number), "parts keep their order");
            }
            let mut all = numbers(&divided);
            all.sort_unstable();
            prop_assert!(all.into_iter().eq(0..items.len() as u32));
            let mut least = f32::INFINITY;
            for axis in 0..3 {
                let centers = || items.iter().map(|item| item.center(axis));
                let range = [centers().fold(f32::INFINITY, f32::min), centers().fold(0.0, f32::max)];
                let mut sorted = items.clone();
                sorted.sort_by_key(|item| bisected(range, item.center(axis)));
                for cut in (packet..items.len()).step_by(packet) {
                    least = least.min(cost(&sorted, cut));
                }
            }
            prop_assert_eq!(cost(&divided, cut), least);
        }

        #[test]
        fn instruction_sets_divide_alike(items in boxes()) {
            let (cut, divided) = Level::Portable.run(Divided(&items, 64));
            for level in Level::here() {
                let (other_cut, other) = level.run(Divided(&items, 64));
                prop_assert_eq!(cut, other_cut);
                prop_assert_eq!(numbers(&divided), numbers(&other));
            }
        }
    }

    #[test]
    fn coinciding_items_are_divided_in_their_order() {
        let items: Vec<Item> =
            (0..130).map(|number| Item::new(number, 1, &UnitBox { min: [0.5; 3], max: [0.5; 3] })).collect();
        let (cut, divided) = Level::Portable.run(Divided(&items, 64));
        assert_eq!(cut, 64);
        assert!(numbers(&divided).into_iter().eq(0..130));
    }
}
