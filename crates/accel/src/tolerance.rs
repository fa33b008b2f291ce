//! The bounds that together guarantee that no hit is lost.

use crate::{Aabb, Ray};

/// Relative slack of t that [`crate::Objects`] allows for.
pub const T_SLACK: f64 = 1.0 / (1 << 20) as f64;

/// The padding of boxes: large against the rounding of a hit's position in `f32`, small
/// against anything seen in an image.
pub fn pad_of(bounds: &Aabb) -> f32 {
    if bounds.is_empty() { 0.0 } else { bounds.extent().max_element() / (1 << 17) as f32 }
}

/// Whether a hit at `t` keeps the law for `bounds`.
#[inline]
pub fn lawful(bounds: &Aabb, ray: &Ray, t: f32) -> bool {
    let Some((near, far)) = bounds.overlap(ray.origin, ray.direction) else {
        return false;
    };
    let t = f64::from(t);
    let slack = T_SLACK * t.abs();
    near - slack <= t && t <= far + slack
}
