//! What hangs on a tree's leaves.

use accel::{Mesh, Objects, Surface, vec_bytes};
use obvhs::aabb::Aabb;
use obvhs::ray::Ray;
use obvhs::rt_triangle::{RtCompressedTriangle, RtTriangle};
use obvhs::triangle::Triangle;

/// Objects in the order of a tree's leaves.
pub trait Leaves: Send + Sync {
    /// Where the object of a slot is hit within the ray's range, +∞ for nowhere.
    fn hit(&self, slot: usize, ray: &Ray) -> f32;

    /// The surface coordinates of a hit that [`Leaves::hit`] has found.
    fn surface(&self, slot: usize, ray: &Ray) -> (f32, f32);

    /// Bytes copied of the scene.
    fn bytes(&self) -> usize;
}

/// The corners of all triangles, as obvhs' builders take them.
pub fn triangles_of<T: Packed>(mesh: &Mesh) -> Vec<Triangle> {
    let triangle = |index| {
        let [v0, v1, v2] = mesh.corners(index).map(Into::into);
        T::seen(Triangle { v0, v1, v2 })
    };
    (0..mesh.triangles.len()).map(triangle).collect()
}

/// One of obvhs' forms of a triangle, with its test.
pub trait Packed: for<'a> From<&'a Triangle> + Send + Sync {
    /// Where the form sees the corners: the tree has to be built over these.
    fn seen(triangle: Triangle) -> Triangle;
    /// t, or +∞ for a miss.
    fn hit(&self, ray: &Ray) -> f32;
    /// u and v.
    fn surface(&self, ray: &Ray) -> (f32, f32);
}

/// The tests of both forms, by methods that they share in name only.
macro_rules! tests {
    () => {
        #[inline(always)]
        fn hit(&self, ray: &Ray) -> f32 {
            self.intersect(ray)
        }

        #[inline(always)]
        fn surface(&self, ray: &Ray) -> (f32, f32) {
            self.compute_barycentric(ray).into()
        }
    };
}

/// With precomputed edges and normal, 64 bytes.
impl Packed for RtTriangle {
    fn seen(triangle: Triangle) -> Triangle {
        triangle
    }

    tests!();
}

/// With its edges in 16-bit floats, 24 bytes. Each triangle rounds for itself, so neighbours no longer share corners.
impl Packed for RtCompressedTriangle {
    fn seen(triangle: Triangle) -> Triangle {
        let [v0, v1, v2] = Self::from(&triangle).vertices();
        Triangle { v0, v1, v2 }
    }

    tests!();
}

/// Triangles as obvhs packs them.
pub struct TriangleLeaves<T>(Vec<T>);

impl<T: Packed> TriangleLeaves<T> {
    /// Slot i holds triangle `order[i]`; a triangle that was split is in several slots.
    pub fn new(triangles: &[Triangle], order: &[u32]) -> Self {
        Self(order.iter().map(|&id| T::from(&triangles[id as usize])).collect())
    }
}

impl<T: Packed> Leaves for TriangleLeaves<T> {
    #[inline(always)]
    fn hit(&self, slot: usize, ray: &Ray) -> f32 {
        self.0[slot].hit(ray)
    }

    #[inline(always)]
    fn surface(&self, slot: usize, ray: &Ray) -> (f32, f32) {
        self.0[slot].surface(ray)
    }

    fn bytes(&self) -> usize {
        vec_bytes(&self.0)
    }
}

/// The padded boxes of objects, as obvhs' builders take them.
pub fn bounds_of(objects: &impl Objects) -> Vec<Aabb> {
    let bounds = |id| {
        let bounds = objects.bounds(id);
        Aabb { min: bounds.min.into(), max: bounds.max.into() }
    };
    (0..objects.len() as u32).map(bounds).collect()
}

/// Objects, tested where they lie in the scene.
pub struct ObjectLeaves<O> {
    objects: O,
    order: Vec<u32>,
}

impl<O: Objects> ObjectLeaves<O> {
    /// Slot i holds object `order[i]`.
    pub fn new(objects: O, order: &[u32]) -> Self {
        Self { objects, order: order.to_vec() }
    }

    #[inline(always)]
    fn surface_of(&self, slot: usize, ray: &Ray) -> Option<Surface> {
        let own = accel::Ray {
            origin: ray.origin.into(),
            direction: ray.direction.into(),
            t_min: ray.tmin,
            t_max: ray.tmax,
        };
        self.objects.intersect(self.order[slot], &own, ray.tmax)
    }
}

impl<O: Objects> Leaves for ObjectLeaves<O> {
    #[inline(always)]
    fn hit(&self, slot: usize, ray: &Ray) -> f32 {
        self.surface_of(slot, ray).map_or(f32::INFINITY, |surface| surface.t)
    }

    #[inline(always)]
    fn surface(&self, slot: usize, ray: &Ray) -> (f32, f32) {
        self.surface_of(slot, ray).map_or((0.0, 0.0), |surface| (surface.u, surface.v))
    }

    fn bytes(&self) -> usize {
        vec_bytes(&self.order)
    }
}
