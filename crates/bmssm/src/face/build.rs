//! From a mesh or objects to a structure.

use super::{Bmssm, Camera, Image, Options};
use crate::fast::Build;
use accel::{Accel, BuildError, Cancel, MeshRef, Objects, Position, Workload};
use primitives::{Guarded, WithObjects, with_triangles};

impl<'s> Bmssm<'s> {
    /// Builds for a mesh: positions as `[f32; 3]` or [`Vec3`](crate::Vec3), and three indices into them for each
    /// triangle.
    ///
    /// # Errors
    /// [`BuildError::Input`] for coordinates that aren't finite, indices out of range and meshes that reach too far,
    /// [`BuildError::TooLarge`] where memory doesn't suffice.
    pub fn build<P: Position>(positions: &'s [P], triangles: &'s [[u32; 3]]) -> Result<Self, BuildError> {
        Options::default().build(positions, triangles)
    }

    /// Builds for objects of any kind.
    ///
    /// # Errors
    /// [`BuildError::Input`] for boxes that are empty or not finite or reach too far, [`BuildError::TooLarge`] where
    /// memory doesn't suffice.
    pub fn build_objects<O: Objects>(objects: &'s O) -> Result<Self, BuildError> {
        Options::default().build_objects(objects)
    }

    /// Builds for the rays of one image of a mesh and no others, in less time and memory.
    ///
    /// # Errors
    /// Those of [`Bmssm::build`].
    pub fn for_image<P: Position>(
        camera: &Camera,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
    ) -> Result<Image<'s>, BuildError> {
        Options::default().for_image(camera, positions, triangles)
    }

    /// Settings other than the default.
    pub fn options() -> Options {
        Options::default()
    }
}

impl Options {
    /// See [`Bmssm::build`].
    ///
    /// # Errors
    /// Those of [`Bmssm::build`].
    pub fn build<'s, P: Position>(
        &self,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
    ) -> Result<Bmssm<'s>, BuildError> {
        self.mesh(positions, triangles, Workload::GENERAL).map(Bmssm::new)
    }

    /// See [`Bmssm::build_objects`].
    ///
    /// # Errors
    /// Those of [`Bmssm::build_objects`].
    pub fn build_objects<'s, O: Objects>(&self, objects: &'s O) -> Result<Bmssm<'s>, BuildError> {
        self.objects(objects, Workload::GENERAL).map(Bmssm::new)
    }

    /// See [`Bmssm::for_image`].
    ///
    /// # Errors
    /// Those of [`Bmssm::build`].
    pub fn for_image<'s, P: Position>(
        &self,
        camera: &Camera,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
    ) -> Result<Image<'s>, BuildError> {
        let built = self.mesh(positions, triangles, Workload::raster(*camera.raster()))?;
        Ok(Image::new(built, *camera))
    }

    /// [`Bmssm::for_image`] for objects of any kind.
    ///
    /// # Errors
    /// Those of [`Bmssm::build_objects`].
    pub fn for_image_of_objects<'s, O: Objects>(
        &self,
        camera: &Camera,
        objects: &'s O,
    ) -> Result<Image<'s>, BuildError> {
        let built = self.objects(objects, Workload::raster(*camera.raster()))?;
        Ok(Image::new(built, *camera))
    }

    fn mesh<'s, P: Position>(
        &self,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
        workload: Workload,
    ) -> Result<Box<dyn Accel + 's>, BuildError> {
        let mesh = MeshRef::new(positions, triangles)?;
        with_triangles(mesh, self.settings.kernel, self.build_for(workload))
    }

    fn objects<'s, O: Objects>(
        &self,
        objects: &'s O,
        workload: Workload,
    ) -> Result<Box<dyn Accel + 's>, BuildError> {
        self.build_for(workload).objects(Guarded::new(objects)?)
    }

    fn build_for(&self, workload: Workload) -> Build<'static> {
        Build { settings: self.settings, workload, cancel: Cancel::NEVER }
    }
}
