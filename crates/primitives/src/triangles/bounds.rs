//! The boxes of triangles, whatever tests them.

use crate::kernel::Storage;
use accel::{Aabb, Bounds, Corners, MeshRef};

/// The triangles of a mesh, kept as `S` has it.
#[derive(Clone, Copy, Debug)]
pub struct TriangleBounds<'s, S> {
    pub(super) mesh: MeshRef<'s>,
    pub(super) storage: S,
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
        let [a, b, c] = self.corners(id);
        Aabb { min: a.min(b).min(c), max: a.max(b).max(c) }.padded(self.pad)
    }
}
