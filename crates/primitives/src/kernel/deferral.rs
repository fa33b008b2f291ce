//! The capability of telling what is certain before a test is decided.

use super::{Many, Packed, Permuted, Prepared};
use accel::Corners;
use lanes::Simd;
use lanes::packet::{Bounds, Lanes, Packet, Vec3Lanes};

/// What a kernel can tell of a test without deciding it.
///
/// Worth while where that is enough to find the nearest hit, and costs so much less than a decision that hits are better
/// decided when the nearest is known. A certain hit must lie in the triangle and its t, once decided, be correctly
/// rounded.
pub trait Deferral: Permuted {
    /// What can be told of [`super::Kernel::triangles`], of the lanes `wanted`.
    fn bounds_one<S: Simd>(s: S, ray: &Self::One, packed: Packed<'_>, wanted: u32, t_max: f32) -> Bounds<S>;

    /// [`super::Kernel::triangles`] for the lanes `undecided` only; the others hold no hit.
    fn decide_one<S: Simd>(s: S, ray: &Self::One, packed: Packed<'_>, undecided: u32, t_max: f32)
    -> Lanes<S>;

    /// What can be told of [`super::Kernel::rays`].
    fn bounds<S: Simd>(s: S, rays: &Many<Self, S>, packed: Packed<'_>, t_max: S::F) -> Bounds<S>;

    /// A row of what is packed beside the corners.
    const SIZE_ROW: usize;

    /// What is packed there, of triangles in lanes.
    fn sizes<S: Simd>(s: S, corners: [Vec3Lanes<S>; 3]) -> S::F;

    /// What can be told of each ray and the triangle in its own lane, of the lanes `wanted`.
    fn bounds_each<S: Simd>(
        s: S,
        rays: &Many<Self, S>,
        corners: [Vec3Lanes<S>; 3],
        sizes: S::F,
        wanted: u32,
        t_max: S::F,
    ) -> Bounds<S>;

    /// [`Deferral::bounds`] of a prepared triangle.
    fn bounds_prepared<S: Simd>(s: S, rays: &Many<Self, S>, prepared: Prepared<'_>, t_max: S::F)
    -> Bounds<S>;

    /// [`super::Kernel::rays`] for the rays `undecided` only; the others hit nothing.
    fn decide<S: Simd>(
        s: S,
        rays: &Many<Self, S>,
        packed: Packed<'_>,
        undecided: u32,
        t_max: S::F,
    ) -> Lanes<S>;

    /// Whether it is plain that any ray that hits both triangles does so at one t, so that the lower number comes first.
    fn at_one_t(a: &Corners, b: &Corners) -> bool;

    /// The hits of the rays `deferred` that were certain, each on the triangle in its own lane.
    fn resolve<S: Simd>(s: S, rays: &Packet<S>, corners: [Vec3Lanes<S>; 3], deferred: u32) -> Lanes<S>;
}

/// Hits that are certain wait until the nearest is known: for kernels with [`Deferral`].
#[derive(Clone, Copy, Debug)]
pub struct Deferred;
