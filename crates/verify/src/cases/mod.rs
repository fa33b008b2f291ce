//! Scenes, rays and settings from numbers: anything that the suite accepts, and much that it has to refuse.

mod image;
mod rays;
mod reach;
mod scene;
mod solids;
mod structure;
mod unusable;

pub use image::{image, small_image};
pub use rays::rays;
pub use reach::{Bounds, CLOSE, Reach, WIDE};
pub use scene::{SHAPES, Shape, closed, scene, scene_of};
pub use solids::{KINDS, solids};
pub use structure::structure;
pub use unusable::{unusable, unusable_image};

use crate::Numbers;
use accel::Vec3;

/// Each coordinate from −1 to 1.
fn point(numbers: &mut impl Numbers) -> Vec3 {
    Vec3::new(numbers.unit(), numbers.unit(), numbers.unit())
}

/// One of nine values on each axis.
fn lattice(numbers: &mut impl Numbers) -> Vec3 {
    let mut at = || (numbers.below(9) as f32 - 4.0) / 4.0;
    Vec3::new(at(), at(), at())
}
