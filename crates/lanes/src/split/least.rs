//! Divisions of a handful of items: all cuts on all axes are weighed.

use super::item::{Extremes, Item};
use super::shape::Shape;

/// Most items that are divided so: of more, bins tell enough and take less.
pub const LEAST: usize = 8;

/// Puts the items into two parts that both keep their order. Answers how many the first one holds.
///
/// # Panics
/// If there are more than [`LEAST`] items, or fewer than two.
#[inline(always)]
pub fn divide_least(shape: &Shape, items: &[Item], out: &mut [Item]) -> usize {
    let len = items.len();
    assert!((2..=LEAST).contains(&len), "a handful of items");
    // The cost, how many go first, and a bit for each of those.
    let mut best = (f32::INFINITY, 1, 1u32);
    for axis in 0..3 {
        let order = ordered(items, axis);
        let mut rests = [0.0; LEAST];
        let mut rest = (Extremes::NONE, 0);
        for k in (1..len).rev() {
            rests[k] = with(shape, &mut rest, &items[order[k]]);
        }
        let (mut first, mut bits) = ((Extremes::NONE, 0), 0);
        for k in 1..len {
            bits |= 1 << order[k - 1];
            let cost = with(shape, &mut first, &items[order[k - 1]]) + rests[k];
            if cost < best.0 {
                best = (cost, k, bits);
            }
        }
    }
    let (_, cut, bits) = best;
    let (mut place, mut rest) = (0, cut);
    for (i, item) in items.iter().enumerate() {
        let at = if bits >> i & 1 != 0 { &mut place } else { &mut rest };
        out[*at] = *item;
        *at += 1;
    }
    cut
}

/// Adds an item to a part, and answers what the part then costs: its surface times its weight.
#[inline(always)]
fn with(shape: &Shape, (range, weight): &mut (Extremes, u32), item: &Item) -> f32 {
    range.gather(&item.extremes());
    *weight += item.weight();
    shape.area(&range.bounds()) * *weight as f32
}

/// The items' numbers by their centres on an axis.
#[inline(always)]
fn ordered(items: &[Item], axis: usize) -> [usize; LEAST] {
    let (mut order, mut centers) = ([0; LEAST], [0.0; LEAST]);
    for (i, item) in items.iter().enumerate() {
        let center = item.center(axis);
        let mut at = i;
        while at > 0 && center < centers[at - 1] {
            (order[at], centers[at]) = (order[at - 1], centers[at - 1]);
            at -= 1;
        }
        (order[at], centers[at]) = (i, center);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::super::UnitBox;
    use super::*;
    use proptest::prelude::*;

    const SHAPE: Shape = Shape { extent: [1.0, 0.5, 0.75] };

    fn items() -> impl Strategy<Value = Vec<Item>> {
        let at = || prop::array::uniform3(0..6u32);
        prop::collection::vec((at(), at(), 1..20u32), 2..=LEAST).prop_map(|boxes| {
            let item = |(number, (at, size, weight)): (usize, ([u32; 3], [u32; 3], u32))| {
                let min = at.map(|at| at as f32 / 16.0);
                let max = [0, 1, 2].map(|axis| min[axis] + size[axis] as f32 / 16.0);
                Item::new(number as u32, weight, &UnitBox { min, max })
            };
            boxes.into_iter().enumerate().map(item).collect()
        })
    }

    fn cost(items: &[Item]) -> f32 {
        let weight: u32 = items.iter().map(Item::weight).sum();
        SHAPE.area(&Extremes::of(items).bounds()) * weight as f32
    }

    proptest! {
        #[test]
        fn no_cut_along_an_axis_is_cheaper(items in items()) {
            let mut out = vec![Item::EMPTY; items.len()];
            let cut = divide_least(&SHAPE, &items, &mut out);
            prop_assert!(cut > 0 && cut < items.len());
            for part in [&out[..cut], &out[cut..]] {
                prop_assert!(part.is_sorted_by_key(Item::number), "parts keep their order");
            }
            let found = cost(&out[..cut]) + cost(&out[cut..]);
            for axis in 0..3 {
                let mut sorted = items.clone();
                sorted.sort_by(|a, b| a.center(axis).total_cmp(&b.center(axis)));
                for cut in 1..items.len() {
                    prop_assert!(found <= cost(&sorted[..cut]) + cost(&sorted[cut..]));
                }
            }
            out.sort_by_key(Item::number);
            prop_assert!(out.iter().map(Item::number).eq(0..items.len() as u32));
        }
    }
}
