//! Scenes: what there is to be hit.

use crate::parallel::prelude::*;
use crate::{Aabb, Corners, Solid, Vec3};
use glam::Vec3A;

/// Triangles looked at by one task.
const CHUNK: usize = 1 << 14;

/// Indexed triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corner positions, finite.
    pub positions: Vec<Vec3>,
    /// Three indices into `positions` for each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The corners of triangle `index`.
    ///
    /// # Panics
    /// If there is no such triangle, or it names no position.
    #[inline(always)]
    pub fn corners(&self, index: usize) -> Corners {
        MeshRef::from(self).corners(index)
    }

    /// The box of all triangles; positions that no triangle uses don't count.
    pub fn bounds(&self) -> Aabb {
        MeshRef::from(self).bounds()
    }
}

/// Indexed triangles in buffers that belong to somebody else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshRef<'s> {
    /// Corner positions, finite.
    pub positions: &'s [Vec3],
    /// Three indices into `positions` for each triangle.
    pub triangles: &'s [[u32; 3]],
}

impl<'s> From<&'s Mesh> for MeshRef<'s> {
    #[inline(always)]
    fn from(mesh: &'s Mesh) -> Self {
        Self { positions: &mesh.positions, triangles: &mesh.triangles }
    }
}

impl MeshRef<'_> {
    /// The corners of triangle `index`.
    ///
    /// # Panics
    /// If there is no such triangle, or it names no position.
    #[inline(always)]
    pub fn corners(&self, index: usize) -> Corners {
        self.triangles[index].map(|corner| self.positions[corner as usize])
    }

    /// The box of all triangles; positions that no triangle uses don't count.
    pub fn bounds(&self) -> Aabb {
        let of = |triangles: &[[u32; 3]]| {
            let (mut min, mut max) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
            for triangle in triangles {
                let [a, b, c] = triangle.map(|corner| Vec3A::from(self.positions[corner as usize]));
                min = min.min(a.min(b).min(c));
                max = max.max(a.max(b).max(c));
            }
            Aabb { min: min.into(), max: max.into() }
        };
        self.triangles.par_chunks(CHUNK).map(of).reduce(|| Aabb::EMPTY, |a, b| a.union(b))
    }
}

/// The objects of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Triangles.
    Triangles(Mesh),
    /// Axis-aligned boxes.
    Boxes(Vec<Aabb>),
    /// Objects of any kinds.
    Solids(Vec<Solid>),
}

impl Geometry {
    /// Number of objects.
    pub fn len(&self) -> usize {
        match self {
            Self::Triangles(mesh) => mesh.triangles.len(),
            Self::Boxes(boxes) => boxes.len(),
            Self::Solids(solids) => solids.len(),
        }
    }

    /// Whether there is no object.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The box of all objects.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Triangles(mesh) => mesh.bounds(),
            Self::Boxes(boxes) => boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b)),
            Self::Solids(solids) => solids.iter().fold(Aabb::EMPTY, |all, s| all.union(s.bounds())),
        }
    }

    /// What kind of objects there are, in the plural.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Triangles(_) => "triangles",
            Self::Boxes(_) => "boxes",
            Self::Solids(_) => "solids",
        }
    }
}

/// From where a scene is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The observer.
    pub eye: Vec3,
    /// A point in the middle of the image.
    pub target: Vec3,
    /// Which way is up.
    pub up: Vec3,
    /// Full vertical angle of view in degrees.
    pub fov_y_degrees: f32,
}

/// A named scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Its name in records.
    pub id: String,
    /// What there is.
    pub geometry: Geometry,
    /// From where it is looked at.
    pub view: View,
}
