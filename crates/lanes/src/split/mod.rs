//! Splits of items in two by the surfaces of their boxes.

mod bins;
mod few;
mod item;
mod least;
mod left;
mod shape;
mod unit_box;

pub use item::{Extremes, Item, whole};
pub use left::{Left, Scratch};
pub use shape::Shape;
pub use unit_box::UnitBox;

use crate::{Simd, Task};

impl Shape {
    /// Reorders the items into two parts, neither empty, and returns the first part's length. Within a
    /// part the items stay in order. They are then in `scratch.items`.
    ///
    /// # Panics
    /// If there are fewer than two items, no more than a packet, or less scratch than items.
    #[inline(always)]
    pub fn divide<S: Simd>(&self, s: S, items: &[Item], scratch: &mut Scratch, left: Left) -> usize {
        match left {
            Left::Whole(packet) if items.len() <= few::FEW => {
                few::divide_few(s, self, items, &mut *scratch.items, packet)
            }
            Left::Any if items.len() == 2 => {
                scratch.items[..2].copy_from_slice(items);
                1
            }
            Left::Any if items.len() <= least::LEAST => least::divide_least(self, items, &mut *scratch.items),
            _ => bins::divide_many(self, items, scratch, left),
        }
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
    fn run<S: Simd>(self, s: S) -> usize {
        let at = self.shape.divide(s, self.items, self.scratch, self.left);
        self.items.copy_from_slice(&self.scratch.items[..self.items.len()]);
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Level;

    const SHAPE: Shape = Shape { extent: [1.0; 3] };

    /// Flat boxes in two heaps that lie close to each other on the axis where they range farthest.
    fn heaps(count: u32, weight: u32) -> Vec<Item> {
        let item = |number: u32| {
            let (along, heap) = ((number / 2) as f32 / count as f32, number % 2);
            let min = [0.5 * along, 0.9 * heap as f32, 0.5];
            let max = [min[0] + 0.5, min[1] + 0.01, 0.6];
            Item::new(number, weight, &UnitBox { min, max })
        };
        (0..count).map(item).collect()
    }

    fn divided(items: &[Item], left: Left, level: Level) -> (usize, Vec<Item>) {
        let (mut items, mut room, mut marks) = (items.to_vec(), items.to_vec(), vec![0; items.len()]);
        let scratch = &mut Scratch { items: &mut room, marks: &mut marks };
        let at = level.run(Divide { shape: &SHAPE, items: &mut items, scratch, left });
        (at, items)
    }

    #[test]
    fn the_axis_that_separates_is_found_whatever_is_divided() {
        for (count, left) in [
            (2, Left::Any),
            (10, Left::Any),
            (600, Left::Any),
            (600, Left::Packed(64)),
            (128, Left::Whole(64)),
            (256, Left::Whole(64)),
            (1024, Left::Whole(64)),
            (5000, Left::Packed(64)),
        ] {
            for level in Level::here() {
                let (at, items) = divided(&heaps(count, 1), left, level);
                assert_eq!(at, count as usize / 2, "{count} {left:?}");
                let heap =
                    |items: &[Item]| items.iter().all(|item| item.number() % 2 == items[0].number() % 2);
                assert!(heap(&items[..at]) && heap(&items[at..]), "{count} {left:?}");
            }
        }
    }

    #[test]
    fn coinciding_items_are_halved() {
        let same = |number| Item::new(number, 1, &UnitBox { min: [0.5; 3], max: [0.5; 3] });
        let items: Vec<Item> = (0..1000).map(same).collect();
        for (left, wanted) in [(Left::Any, 500), (Left::Packed(64), 500), (Left::Whole(64), 512)] {
            assert_eq!(divided(&items, left, Level::Portable).0, wanted);
        }
    }
}
