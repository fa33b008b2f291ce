//! A structure for one image.

use crate::Camera;
use accel::{Accel, Footprint, Hit, RaySet};
use std::fmt;

/// A scene as one camera sees it. It answers for the camera's pixels, which are all that can be asked for.
pub struct Image<'s> {
    built: Box<dyn Accel + 's>,
    camera: Camera,
}

impl<'s> Image<'s> {
    pub(super) fn new(built: Box<dyn Accel + 's>, camera: Camera) -> Self {
        Self { built, camera }
    }

    /// The camera that it was built for.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// What each pixel shows, row by row from the top. With the feature `parallel` on all threads of the current
    /// rayon pool.
    pub fn trace(&self) -> Vec<Option<Hit>> {
        let mut hits = vec![None; self.camera.raster().len()];
        self.built.trace(&RaySet::Raster(*self.camera.raster()), &mut hits);
        hits
    }

    /// What one pixel shows; nothing outside of the image.
    pub fn closest(&self, row: u32, col: u32) -> Option<Hit> {
        self.camera.ray(row, col).and_then(|ray| self.built.closest(&ray))
    }

    /// What the structure holds in memory, part by part, beside the caller's own buffers.
    pub fn footprint(&self) -> Footprint {
        self.built.footprint()
    }
}

impl fmt::Debug for Image<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Image").field("camera", &self.camera).field("footprint", &self.footprint()).finish()
    }
}
