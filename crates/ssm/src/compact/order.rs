//! The order in which objects are packed.

use super::ID;
use accel::parallel::prelude::*;
use accel::{Aabb, Bounds, BuildError};
use lanes::{EMPTY_SLOT, ROW};

/// Objects tested together: what one reference of a cell stands for.
pub(super) const GROUP: usize = ROW;

/// How the objects are packed.
pub(super) struct Order {
    /// The object of each slot, or an empty slot. The first group holds what is set apart.
    pub slots: Vec<u32>,
    /// Whether any object is set apart.
    pub apart: bool,
    /// The box of the others.
    pub bounds: Aabb,
}

/// The part of the scene's largest extent from which on an object is large.
const LARGE: f64 = 0.25;

/// Sets the largest objects apart, a group at most, and puts the others in order.
///
/// A few objects as large as the scene would be listed all over the grid, and stretch it.
///
/// # Errors
/// [`BuildError::TooLarge`] if the system doesn't give the memory.
pub(super) fn order<B: Bounds>(objects: &B) -> Result<Order, BuildError> {
    let all = crate::resolution::bounds(objects);
    let size = |bounds: &Aabb| {
        (0..3).map(|a| f64::from(bounds.max[a]) - f64::from(bounds.min[a])).fold(0.0, f64::max)
    };
    let least = LARGE * size(&all);
    let tasks = objects.len().div_ceil(TASK);
    let of_task = |task: usize| {
        let mut largest = Largest::NONE;
        for id in task * TASK..objects.len().min((task + 1) * TASK) {
            let size = size(&objects.bounds(id as u32));
            if size > least {
                largest.add((size, id as u32));
            }
        }
        largest
    };
    let largest = (0..tasks).into_par_iter().map(of_task).reduce(|| Largest::NONE, Largest::with);
    let mut ids = [0; GROUP];
    let large = largest.ids(&mut ids);
    let bounds = crate::resolution::bounds_of(objects, |id| large.binary_search(&id).is_err());
    let apart = large.len().next_multiple_of(GROUP);
    let others = objects.len() - large.len();
    let len = apart + others.next_multiple_of(GROUP);
    let mut slots = accel::reserved(ID, len)?;
    slots.extend_from_slice(large);
    slots.resize(apart, EMPTY_SLOT);
    let keyed = morton(objects, &bounds, |id| large.binary_search(&id).is_err())?;
    slots.extend(keyed[..others].iter().map(|(_, id)| *id));
    slots.resize(len, EMPTY_SLOT);
    Ok(Order { slots, apart: !large.is_empty(), bounds })
}

/// Objects looked at by one task.
const TASK: usize = 1 << 12;

/// The largest of the objects seen, a group at most; of equal ones the first. In one place, so that it takes no memory that may fail.
#[derive(Clone, Copy)]
struct Largest {
    /// Sizes and numbers, the largest first.
    held: [(f64, u32); GROUP],
    len: usize,
}

impl Largest {
    const NONE: Self = Self { held: [(0.0, 0); GROUP], len: 0 };

    fn add(&mut self, (size, id): (f64, u32)) {
        let goes_before = |held: &(f64, u32)| held.0.total_cmp(&size).reverse().then(held.1.cmp(&id)).is_lt();
        let place = self.held[..self.len].partition_point(goes_before);
        if place < GROUP {
            self.len = GROUP.min(self.len + 1);
            self.held[place..self.len].rotate_right(1);
            self.held[place] = (size, id);
        }
    }

    fn with(mut self, other: Self) -> Self {
        other.held[..other.len].iter().for_each(|held| self.add(*held));
        self
    }

    /// The numbers in order.
    fn ids(self, all: &mut [u32; GROUP]) -> &[u32] {
        *all = self.held.map(|(_, id)| id);
        let ids = &mut all[..self.len];
        ids.sort_unstable();
        ids
    }
}

/// Objects along a Morton curve through the centres of their boxes, so that the objects of a group are
/// neighbours, each behind its key; those that are not wanted come last.
fn morton<B: Bounds>(
    objects: &B,
    bounds: &Aabb,
    wanted: impl Fn(u32) -> bool + Sync,
) -> Result<Vec<(u64, u32)>, BuildError> {
    let scale = [0, 1, 2].map(|a| {
        let extent = f64::from(bounds.max[a]) - f64::from(bounds.min[a]);
        if extent > 0.0 { f64::from(1 << BITS) / extent } else { 0.0 }
    });
    let key = |id: u32| {
        let center = objects.bounds(id).center();
        let spread_axis = |a: usize| {
            let place = (f64::from(center[a]) - f64::from(bounds.min[a])) * scale[a];
            spread((place as u64).min((1 << BITS) - 1)) << a
        };
        spread_axis(0) | spread_axis(1) | spread_axis(2)
    };
    let mut keyed = accel::reserved(ID, objects.len())?;
    keyed.resize(objects.len(), (u64::MAX, 0));
    keyed.par_iter_mut().with_min_len(1 << 12).enumerate().for_each(|(id, place)| {
        let id = id as u32;
        *place = (if wanted(id) { key(id) } else { u64::MAX }, id);
    });
    keyed.par_sort_unstable();
    Ok(keyed)
}

/// Bits of a coordinate in a key.
const BITS: u32 = 20;

/// Bit i of the low 21 to bit 3i.
fn spread(v: u64) -> u64 {
    let v = (v | v << 32) & 0x001f_0000_0000_ffff;
    let v = (v | v << 16) & 0x001f_0000_ff00_00ff;
    let v = (v | v << 8) & 0x100f_00f0_0f00_f00f;
    let v = (v | v << 4) & 0x10c3_0c30_c30c_30c3;
    (v | v << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;
    use primitives::Boxes;

    #[test]
    fn the_largest_are_those_that_sorting_puts_first() {
        let sizes: Vec<(f64, u32)> = (0..100).map(|id| (f64::from(id * 37 % 23), id)).collect();
        let mut sorted = sizes.clone();
        sorted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for parts in [1, 7, 50] {
            for count in [0, 5, GROUP, 100] {
                let largest = sizes[..count].chunks(parts).map(|part| {
                    let mut largest = Largest::NONE;
                    part.iter().for_each(|held| largest.add(*held));
                    largest
                });
                let all = largest.fold(Largest::NONE, Largest::with);
                let mut expected: Vec<_> = sorted
                    .iter()
                    .filter(|held| (held.1 as usize) < count)
                    .take(GROUP)
                    .map(|held| held.1)
                    .collect();
                expected.sort_unstable();
                assert_eq!(all.ids(&mut [0; GROUP]), expected);
            }
        }
    }

    #[test]
    fn bits_are_spread() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
    }

    #[test]
    fn every_object_has_one_slot() {
        let mut boxes: Vec<Aabb> = (0..37)
            .map(|i| Aabb::of_points([Vec3::new((i * 7 % 37) as f32, 0.0, (i * 5 % 11) as f32)]))
            .collect();
        boxes[5].max.x = 60.0;
        let order = order(&Boxes::new(&boxes)).unwrap();
        assert_eq!(order.slots.len(), 16 + 48);
        assert!(order.apart && order.bounds.max.x < 37.0);
        assert_eq!(order.slots[..2], [5, EMPTY_SLOT]);
        let mut order: Vec<u32> = order.slots.into_iter().filter(|id| *id != EMPTY_SLOT).collect();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..37));
    }
}
