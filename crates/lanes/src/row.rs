//! Rows of packed geometry.

/// Lanes in a row of packed geometry: the widest implementation's width, a multiple of all.
pub const ROW: usize = 16;

/// A row of packed geometry, aligned for the widest load.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Row(pub [f32; ROW]);
