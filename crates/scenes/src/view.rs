//! Cameras for scenes that bring none.

use accel::{Aabb, Geometry, Vec3, View};

/// A camera that sees the whole geometry from above one corner.
pub fn framing(geometry: &Geometry) -> View {
    let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    let bounds = if geometry.is_empty() { unit } else { geometry.bounds() };
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let center = (min + max) * 0.5;
    let radius = (0.5 * (max - min)).length();
    // A scene of one point, or one too small beside its offset, still needs a distance.
    let radius = radius.max(center.length() * 1e-6).max(1e-30);
    let fov_y_degrees = 45.0;
    // A sphere fills the view from a distance of radius / sin(fov / 2).
    let distance = radius / libm::sin(f64::from(fov_y_degrees).to_radians() * 0.5);
    let towards = glam::DVec3::new(0.55, -0.7, 0.45).normalize();
    View {
        eye: (center + towards * distance).as_vec3(),
        target: center.as_vec3(),
        up: Vec3::Z,
        fov_y_degrees,
    }
}
