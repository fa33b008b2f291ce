//! Triangles by their corners.

use crate::Vec3;

/// The three corners of a triangle.
pub type Corners = [Vec3; 3];
