//! The order in which objects are packed.

use accel::objects::EMPTY_SLOT;
use accel::simd::ROW;
use accel::{Aabb, Objects};
use rayon::prelude::*;

/// Objects tested together: what one reference of a cell stands for.
pub(super) const GROUP: usize = ROW;

/// Objects along a Morton curve through the centres of their boxes, so that the objects of a group are
/// neighbours; the last group is filled up with empty slots.
pub(super) fn morton<O: Objects>(objects: &O, bounds: &Aabb) -> Vec<u32> {
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
    let ids = (0..objects.len() as u32).into_par_iter().with_min_len(1 << 12);
    let mut keyed: Vec<(u64, u32)> = ids.map(|id| (key(id), id)).collect();
    keyed.par_sort_unstable();
    let slots = keyed.len().next_multiple_of(GROUP);
    let order = keyed.into_iter().map(|(_, id)| id);
    order.chain(std::iter::repeat(EMPTY_SLOT)).take(slots).collect()
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
    use accel::objects::Boxes;

    #[test]
    fn bits_are_spread() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
    }

    #[test]
    fn every_object_has_one_slot() {
        let boxes: Vec<Aabb> = (0..37)
            .map(|i| Aabb::of_points([Vec3::new((i * 7 % 37) as f32, 0.0, (i * 5 % 11) as f32)]))
            .collect();
        let objects = Boxes::new(&boxes);
        let mut order = morton(&objects, &crate::resolution::bounds(&objects));
        assert_eq!(order.len(), 48);
        order.sort_unstable();
        assert!(order[..37].iter().copied().eq(0..37) && order[37..].iter().all(|id| *id == EMPTY_SLOT));
    }
}
