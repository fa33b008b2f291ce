//! What others use: a structure for rays of any kind, and how it is built.

use crate::compact::{Build, Ssm as Builder};
use crate::resolution::Resolution;
use accel::{AnyRays, BuildError, Cancel, MeshRef, Objects, Position};
use lanes::Level;
use primitives::{Guarded, KernelId, WithObjects, with_triangles};
use std::ops::Deref;

/// A scene that any ray can be traced through, by the functions of [`AnyRays`]: a compact uniform grid.
///
/// The mesh stays in the caller's buffers, which are borrowed.
#[derive(Debug)]
pub struct Ssm<'s>(AnyRays<'s>);

impl<'s> Ssm<'s> {
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

    /// Settings other than the default.
    pub fn options() -> Options {
        Options::default()
    }
}

impl<'s> Deref for Ssm<'s> {
    type Target = AnyRays<'s>;

    fn deref(&self) -> &AnyRays<'s> {
        &self.0
    }
}

/// Settings of a grid, and the way to build it with them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct Options {
    builder: Builder,
}

impl Options {
    /// The ray-triangle intersector: Möller–Trumbore unless told otherwise. Objects of other kinds bring their own.
    pub fn kernel(mut self, kernel: KernelId) -> Self {
        self.builder.settings.kernel = kernel;
        self
    }

    /// The instruction set: the widest that the machine has unless told otherwise. One that it lacks is replaced by
    /// plain Rust. The hits are the same with all of them.
    pub fn simd(mut self, simd: Level) -> Self {
        self.builder.settings.simd = simd;
        self
    }

    /// Cells for each object: 0.4 unless told otherwise. More make rays faster and the grid larger, up to a point.
    pub fn density(mut self, cells_per_object: f64) -> Self {
        self.builder.settings.resolution = Resolution::Density(cells_per_object);
        self
    }

    /// Most bytes that the grid may take: what the machine has available unless told otherwise.
    pub fn memory_limit(mut self, bytes: u64) -> Self {
        self.builder.settings.memory = Some(bytes.into());
        self
    }

    /// See [`Ssm::build`].
    ///
    /// # Errors
    /// Those of [`Ssm::build`], and [`BuildError::Setting`] for a density that is not above 0 and finite.
    pub fn build<'s, P: Position>(
        &self,
        positions: &'s [P],
        triangles: &'s [[u32; 3]],
    ) -> Result<Ssm<'s>, BuildError> {
        self.check()?;
        let mesh = MeshRef::new(positions, triangles)?;
        with_triangles(mesh, self.builder.settings.kernel, self.way()).map(AnyRays::new).map(Ssm)
    }

    /// See [`Ssm::build_objects`].
    ///
    /// # Errors
    /// Those of [`Ssm::build_objects`], and [`BuildError::Setting`] for a density that is not above 0 and finite.
    pub fn build_objects<'s, O: Objects>(&self, objects: &'s O) -> Result<Ssm<'s>, BuildError> {
        self.check()?;
        self.way().objects(Guarded::new(objects)?).map(AnyRays::new).map(Ssm)
    }

    fn way(&self) -> Build<'static> {
        Build(self.builder, Cancel::NEVER)
    }

    fn check(&self) -> Result<(), BuildError> {
        match self.builder.settings.resolution {
            Resolution::Density(density) if !(density > 0.0 && density.is_finite()) => {
                let problem = format!("{density} is not a number of cells for each object above 0");
                Err(BuildError::Setting { structure: "ssm".into(), setting: "density".into(), problem })
            }
            _ => Ok(()),
        }
    }
}
