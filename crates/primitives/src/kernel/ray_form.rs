//! How kernels want their rays.

use accel::Ray;
use lanes::Simd;
use lanes::packet::Packet;

/// What is computed once for a ray, before it meets triangles: of a [`Ray`] itself, nothing.
pub trait RayForm: Copy + Send + Sync + 'static {
    /// The same of `LANES` rays.
    type Many<S: Simd>: Copy;

    /// Prepares one ray.
    fn one(ray: &Ray) -> Self;

    /// Prepares `LANES` rays.
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> Self::Many<S>;
}

impl RayForm for Ray {
    type Many<S: Simd> = Packet<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Self {
        *ray
    }

    #[inline(always)]
    fn many<S: Simd>(_: S, rays: &Packet<S>) -> Packet<S> {
        *rays
    }
}
