//! The two images of a scene.

use super::frame::Frame;
use accel::{Aabb, Raster, View};
use glam::DVec3;

/// The image of square pixels that the view says; the direction of the middle ray has unit length.
pub fn perspective(view: &View, rows: u32, cols: u32) -> Raster {
    Raster::perspective(view, rows, cols)
}

/// The image of square pixels by rays along the view's direction that just holds `bounds`, starting before
/// them.
pub fn parallel(view: &View, bounds: &Aabb, rows: u32, cols: u32) -> Raster {
    let axes = view.axes();
    let [forward, right, up] = axes;
    let frame = Frame::around(bounds);
    let half = (frame.max - frame.min) * 0.5;
    let half_along = |axis: DVec3| half.dot(axis.abs());
    let needed = |axis: DVec3, pixels: u32| 2.0 * half_along(axis) / f64::from(pixels.max(1));
    let step = needed(right, cols).max(needed(up, rows));
    let step = if step > 0.0 { step } else { 2.0 * frame.radius / f64::from(cols.max(rows).max(1)) };
    let start = frame.center() - forward * (half_along(forward) + 0.125 * frame.radius);
    Raster::parallel(axes, start, step, rows, cols)
}
