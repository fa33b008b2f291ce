//! What splits weigh.

use super::UnitBox;

/// What splits weigh.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// True extents of the unit coordinates' axes, up to a common factor.
    pub extent: [f32; 3],
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
}
