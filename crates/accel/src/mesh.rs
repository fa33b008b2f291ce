//! Indexed triangles.

use crate::parallel::prelude::*;
use crate::{Aabb, Corners, Vec3};
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
        // One by one: an array that is mapped goes through memory.
        let [a, b, c] = self.triangles[index];
        [self.positions[a as usize], self.positions[b as usize], self.positions[c as usize]]
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
