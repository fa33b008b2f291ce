//! The boxes of triangles, whatever tests them.

use crate::kernel::Storage;
use accel::{Aabb, Bounds, Corners, MeshRef};
use glam::Vec3A;

/// The triangles of a mesh, kept as `S` has it.
#[derive(Clone, Copy, Debug)]
pub struct TriangleBounds<'s, S> {
    pub(super) mesh: MeshRef<'s>,
    pub(super) storage: S,
    /// The box of all triangles.
    pub(super) hull: Aabb,
    pub(super) pad: f32,
}

impl<S: Storage> TriangleBounds<'_, S> {
    /// The corners of a triangle, where kernels see them.
    #[inline(always)]
    pub(super) fn corners(&self, id: u32) -> Corners {
        let [a, b, c] = self.mesh.corners(id as usize);
        [self.storage.place(a), self.storage.place(b), self.storage.place(c)]
    }
}

impl<S: Storage> Bounds for TriangleBounds<'_, S> {
    fn len(&self) -> usize {
        self.mesh.triangles.len()
    }

    #[inline(always)]
    fn bounds(&self, id: u32) -> Aabb {
        let [a, b, c] = self.corners(id).map(Vec3A::from);
        Aabb { min: a.min(b).min(c).into(), max: a.max(b).max(c).into() }.padded(self.pad)
    }

    #[inline(always)]
    fn hull(&self) -> Aabb {
        if self.hull.is_empty() { self.hull } else { self.hull.padded(self.pad) }
    }
}
