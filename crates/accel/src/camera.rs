//! Images of square pixels as a view says them.

use crate::{Projection, Raster, View};
use glam::DVec3;

impl View {
    /// The direction of view, right and up, orthonormal. A view without a direction looks along −z; one whose
    /// `up` lies in its direction takes any.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = (self.target.as_dvec3() - self.eye.as_dvec3()).normalize_or(DVec3::NEG_Z);
        let across = forward.cross(self.up.as_dvec3());
        let right = across.try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        [forward, right, right.cross(forward)]
    }
}

impl Raster {
    /// The perspective image of a view; the direction of the middle ray has unit length.
    pub fn perspective(view: &View, rows: u32, cols: u32) -> Self {
        let [forward, right, up] = view.axes();
        let half = libm::tan(0.5 * f64::from(view.fov_y_degrees).to_radians());
        let step = 2.0 * half / f64::from(rows.max(1));
        let corner = forward - right * (0.5 * step * f64::from(cols)) + up * half;
        Self {
            projection: Projection::Perspective,
            rows,
            cols,
            origin: view.eye,
            forward: corner.as_vec3(),
            right: (right * step).as_vec3(),
            down: (up * -step).as_vec3(),
        }
    }

    /// The image by rays along `axes[0]` from a plane whose middle is `center`, `step` being the side of a pixel. `axes` are a
    /// view's.
    pub fn parallel(axes: [DVec3; 3], center: DVec3, step: f64, rows: u32, cols: u32) -> Self {
        let [forward, right, up] = axes;
        let corner = center - right * (0.5 * step * f64::from(cols)) + up * (0.5 * step * f64::from(rows));
        Self {
            projection: Projection::Parallel,
            rows,
            cols,
            origin: corner.as_vec3(),
            forward: forward.as_vec3(),
            right: (right * step).as_vec3(),
            down: (up * -step).as_vec3(),
        }
    }
}
