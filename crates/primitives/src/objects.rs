//! The objects of a scene as a type.

use crate::{Boxes, KernelId, TriangleKernel, Triangles, WithKernel};
use accel::{Geometry, MeshRef, Scene};
use lanes::PackedObjects;
use solids::Solids;

/// Code that is generic over the objects of a scene.
pub trait WithObjects<'s> {
    /// What it computes.
    type Out;
    /// Does it with these objects.
    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out;
}

/// Calls `with` with the objects of a scene, triangles being tested by `kernel`.
pub fn with_objects<'s, W: WithObjects<'s>>(scene: &'s Scene, kernel: KernelId, with: W) -> W::Out {
    match &scene.geometry {
        Geometry::Triangles(mesh) => with_triangles(mesh.into(), kernel, with),
        Geometry::Boxes(boxes) => with.objects(Boxes::new(boxes)),
        Geometry::Solids(solids) => with.objects(match kernel {
            #[cfg(feature = "exact")]
            KernelId::Exact => Solids::exact(solids),
            KernelId::Double => Solids::in_double(solids),
            _ => Solids::new(solids),
        }),
    }
}

/// Calls `with` with the triangles of a mesh, tested by `kernel`.
pub fn with_triangles<'s, W: WithObjects<'s>>(mesh: MeshRef<'s>, kernel: KernelId, with: W) -> W::Out {
    struct OfMesh<'s, W>(MeshRef<'s>, W);
    impl<'s, W: WithObjects<'s>> WithKernel for OfMesh<'s, W> {
        type Out = W::Out;
        fn kernel<K: TriangleKernel>(self) -> W::Out {
            self.1.objects(Triangles::<K>::new(self.0))
        }
    }
    kernel.with(OfMesh(mesh, with))
}
