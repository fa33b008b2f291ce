//! Triangles and rays that hunt for errors of an exact test.

use accel::{Corners, Vec3};
use proptest::prelude::*;

/// Few values, so that much coincides.
pub fn lattice() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![4 => (-3i8..=3).prop_map(f32::from), 1 => Just(-0.0f32), 1 => Just(0.5f32)]
}

/// Vectors of such coordinates.
pub fn vector(of: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Vec3> {
    [of.clone(), of.clone(), of].prop_map(Vec3::from)
}

/// Triangles with such coordinates.
pub fn corners(of: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Corners> {
    [vector(of.clone()), vector(of.clone()), vector(of)]
}

/// Weights of the corners, often of an edge's or a corner's point.
pub fn weights() -> impl Strategy<Value = [f32; 3]> {
    let one = prop_oneof![Just(0f32), Just(1.0), 0f32..1.0];
    [one.clone(), one.clone(), one]
}

/// The point of a triangle with these weights.
pub fn aim(triangle: &Corners, weights: [f32; 3]) -> Vec3 {
    let sum = weights.iter().sum::<f32>().max(1e-3);
    (0..3).fold(Vec3::ZERO, |p, k| p + triangle[k] * (weights[k] / sum))
}
