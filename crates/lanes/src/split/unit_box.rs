//! Boxes in the unit coordinates of the scene.

use accel::grid::MARGIN;

/// A box in the unit coordinates of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitBox {
    /// Least coordinates.
    pub min: [f32; 3],
    /// Greatest coordinates.
    pub max: [f32; 3],
}

impl UnitBox {
    /// The box widened by the margin of [`accel::grid`].
    #[inline]
    pub fn widened(&self) -> Self {
        let margin = MARGIN as f32;
        Self { min: self.min.map(|v| v - margin), max: self.max.map(|v| v + margin) }
    }
}
