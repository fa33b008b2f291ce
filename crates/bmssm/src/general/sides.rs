//! The sides of a block's boxes, axis by axis.

use lanes::BLOCK;
use lanes::split::{Item, UnitBox};

/// Where the boxes of up to 64 objects begin and end on each axis, widened by the margin of registration.
///
/// A slot without an object begins behind everything and ends before it.
pub struct Sides {
    pub(super) low: [[f32; BLOCK]; 3],
    pub(super) high: [[f32; BLOCK]; 3],
    /// How many objects there are.
    pub(super) len: usize,
}

impl Sides {
    /// Of these objects, by position.
    ///
    /// # Panics
    /// If they are more than 64.
    #[inline(always)]
    pub fn of(objects: &[Item]) -> Self {
        let mut sides = Self {
            low: [[f32::INFINITY; BLOCK]; 3],
            high: [[f32::NEG_INFINITY; BLOCK]; 3],
            len: objects.len(),
        };
        for (slot, object) in objects.iter().enumerate() {
            let UnitBox { min, max } = object.bounds().widened();
            for axis in 0..3 {
                (sides.low[axis][slot], sides.high[axis][slot]) = (min[axis], max[axis]);
            }
        }
        sides
    }
}
