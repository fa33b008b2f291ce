//! Cameras that an image structure can be built for.

use accel::{Raster, Ray, Vec3, View};

/// An image of square pixels: one ray through the middle of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera(Raster);

/// Why there is no such camera.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The image has no row or column, or too many.
    #[error("an image of {0} x {1} pixels; there must be from 1 to {most} each way", most = Camera::MAX)]
    Size(u32, u32),
    /// The eye, the target or the direction up is not finite, or too large to reckon with.
    #[error("the camera's eye, target and up are not all finite and of sensible size")]
    NotFinite,
    /// The eye is at the target, or up points along the view.
    #[error("the camera's eye, target and up say no direction of view")]
    Direction,
    /// The angle of view is not between 0 and 180 degrees, or the height of the image not above 0.
    #[error("an image of {0} degrees or units of height")]
    Height(f32),
}

impl Camera {
    /// Most rows or columns.
    pub const MAX: u32 = 1 << 16;

    /// Rays from `eye`; `fov_y_degrees` is the full vertical angle of view.
    ///
    /// # Errors
    /// [`CameraError`] says which part makes no image.
    pub fn perspective(
        eye: impl Into<Vec3>,
        target: impl Into<Vec3>,
        up: impl Into<Vec3>,
        fov_y_degrees: f32,
        [rows, cols]: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !(fov_y_degrees > 0.0 && fov_y_degrees < 180.0) {
            return Err(CameraError::Height(fov_y_degrees));
        }
        let view = View { eye: eye.into(), target: target.into(), up: up.into(), fov_y_degrees };
        Self::check(&view, rows, cols)?;
        Self::of(Raster::perspective(&view, rows, cols))
    }

    /// Parallel rays along the direction from `eye` to `target`, starting from a plane through `eye`; `height` is
    /// that of the image in the scene's units.
    ///
    /// # Errors
    /// [`CameraError`] says which part makes no image.
    pub fn parallel(
        eye: impl Into<Vec3>,
        target: impl Into<Vec3>,
        up: impl Into<Vec3>,
        height: f32,
        [rows, cols]: [u32; 2],
    ) -> Result<Self, CameraError> {
        if !(height > 0.0 && height.is_finite()) {
            return Err(CameraError::Height(height));
        }
        let view = View { eye: eye.into(), target: target.into(), up: up.into(), fov_y_degrees: 90.0 };
        Self::check(&view, rows, cols)?;
        let step = f64::from(height) / f64::from(rows);
        Self::of(Raster::parallel(view.axes(), view.eye.as_dvec3(), step, rows, cols))
    }

    fn check(view: &View, rows: u32, cols: u32) -> Result<(), CameraError> {
        if [rows, cols].iter().any(|n| !(1..=Self::MAX).contains(n)) {
            return Err(CameraError::Size(rows, cols));
        }
        let [eye, target, up] = [view.eye, view.target, view.up];
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        let across = (target.as_dvec3() - eye.as_dvec3()).cross(up.as_dvec3());
        if across.try_normalize().is_none() { Err(CameraError::Direction) } else { Ok(()) }
    }

    fn of(raster: Raster) -> Result<Self, CameraError> {
        let corners = [(0, 0), (raster.rows - 1, raster.cols - 1)];
        let sound = corners.iter().all(|&(row, col)| raster.ray(row, col).validate().is_ok());
        let steps = raster.right != Vec3::ZERO && raster.down != Vec3::ZERO;
        if sound && steps { Ok(Self(raster)) } else { Err(CameraError::NotFinite) }
    }

    /// Rows and columns.
    pub fn size(&self) -> [u32; 2] {
        [self.0.rows, self.0.cols]
    }

    /// The ray of a pixel, from the top left; `None` outside of the image.
    pub fn ray(&self, row: u32, col: u32) -> Option<Ray> {
        (row < self.0.rows && col < self.0.cols).then(|| self.0.ray(row, col))
    }

    pub(super) fn raster(&self) -> &Raster {
        &self.0
    }
}
