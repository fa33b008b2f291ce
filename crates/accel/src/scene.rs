//! Scenes: what there is to be hit.

use crate::{Aabb, Mesh, Solid, Vec3};

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
