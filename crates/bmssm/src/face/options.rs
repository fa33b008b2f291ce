//! How a structure is built.

use super::{Bmssm, Camera, Image};
use crate::fast::{Build, Settings};
use accel::{Accel, BuildError, MeshRef, Need, Objects, Position};
use lanes::Level;
use primitives::{Guarded, KernelId, WithObjects, with_triangles};

/// Settings of a structure, and the way to build it with them.
///
/// ```
/// use bmssm::{Bmssm, Kernel};
///
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let options = Bmssm::options().kernel(Kernel::Watertight).memory_limit(1 << 30);
/// let bmssm = options.build(&positions, &[[0, 1, 2]])?;
/// # assert!(bmssm.footprint().total() < 1 << 30);
/// # Ok::<(), bmssm::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct Options {
    settings: Settings,
}

impl Options {
    /// The ray-triangle intersector: Möller–Trumbore unless told otherwise. Objects of other kinds bring their own.
    pub fn kernel(mut self, kernel: KernelId) -> Self {
        self.settings.kernel = kernel;
        self
    }

    /// The instruction set: the widest that the machine has unless told otherwise. One that it lacks is replaced by
    /// plain Rust. The hits are the same with all of them.
    pub fn simd(mut self, simd: Level) -> Self {
        self.settings.simd = simd;
        self
    }

    /// Most bytes that the structure may take: what the machine has available unless told otherwise.
    pub fn memory_limit(mut self, bytes: u64) -> Self {
        self.settings.memory = Some(bytes.into());
        self
    }

    /// See [`Bmssm::build`].
    ///
    /// # Errors
    /// Those of [`Bmssm::build`].
    pub fn build<'s, P: Position>(
        &self,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
    ) -> Result<Bmssm<'s>, BuildError> {
        self.mesh(positions, triangles, Need::GENERAL).map(Bmssm::new)
    }

    /// See [`Bmssm::build_objects`].
    ///
    /// # Errors
    /// Those of [`Bmssm::build_objects`].
    pub fn build_objects<'s, O: Objects>(&self, objects: &'s O) -> Result<Bmssm<'s>, BuildError> {
        self.objects(objects, Need::GENERAL).map(Bmssm::new)
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
        let built = self.mesh(positions, triangles, Need::raster(*camera.raster()))?;
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
        let built = self.objects(objects, Need::raster(*camera.raster()))?;
        Ok(Image::new(built, *camera))
    }

    fn mesh<'s, P: Position>(
        &self,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
        need: Need,
    ) -> Result<Box<dyn Accel + 's>, BuildError> {
        let mesh = MeshRef::new(positions, triangles)?;
        with_triangles(mesh, self.settings.kernel, Build { settings: self.settings, need })
    }

    fn objects<'s, O: Objects>(&self, objects: &'s O, need: Need) -> Result<Box<dyn Accel + 's>, BuildError> {
        Build { settings: self.settings, need }.objects(Guarded::new(objects)?)
    }
}
