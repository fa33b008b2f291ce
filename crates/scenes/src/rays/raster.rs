//! The two images of a scene.

use super::frame::Frame;
use accel::{Aabb, Projection, Raster, View};
use glam::DVec3;

/// The view's direction, right and up, orthonormal.
fn axes(view: &View) -> [DVec3; 3] {
    let forward = (view.target.as_dvec3() - view.eye.as_dvec3()).normalize_or(DVec3::NEG_Z);
    let across = forward.cross(view.up.as_dvec3());
    let right = across.try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
    [forward, right, right.cross(forward)]
}

/// The image of square pixels that the view says; the direction of the middle ray has unit length.
pub fn perspective(view: &View, rows: u32, cols: u32) -> Raster {
    let [forward, right, up] = axes(view);
    let half = libm::tan(0.5 * f64::from(view.fov_y_degrees).to_radians());
    let step = 2.0 * half / f64::from(rows.max(1));
    let corner = forward - right * (0.5 * step * f64::from(cols)) + up * half;
    Raster {
        projection: Projection::Perspective,
        rows,
        cols,
        origin: view.eye,
        forward: corner.as_vec3(),
        right: (right * step).as_vec3(),
        down: (up * -step).as_vec3(),
    }
}

/// The image of square pixels by rays along the view's direction that just holds `bounds`, starting before
/// them.
pub fn parallel(view: &View, bounds: &Aabb, rows: u32, cols: u32) -> Raster {
    let [forward, right, up] = axes(view);
    let frame = Frame::around(bounds);
    let half = (frame.max - frame.min) * 0.5;
    let half_along = |axis: DVec3| half.dot(axis.abs());
    let needed = |axis: DVec3, pixels: u32| 2.0 * half_along(axis) / f64::from(pixels.max(1));
    let step = needed(right, cols).max(needed(up, rows));
    let step = if step > 0.0 { step } else { 2.0 * frame.radius / f64::from(cols.max(rows).max(1)) };
    let start = frame.center() - forward * (half_along(forward) + 0.125 * frame.radius);
    let corner = start - right * (0.5 * step * f64::from(cols)) + up * (0.5 * step * f64::from(rows));
    Raster {
        projection: Projection::Parallel,
        rows,
        cols,
        origin: corner.as_vec3(),
        forward: forward.as_vec3(),
        right: (right * step).as_vec3(),
        down: (up * -step).as_vec3(),
    }
}
