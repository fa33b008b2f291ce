//! Ray-triangle tests as type parameters.
//!
//! A kernel is written once, over the lanes of [`Simd`], and used in two ways: one ray
//! against several triangles (lists of rays) and several rays against one triangle
//! (rasters). Both, and the scalar form, give the same bits.
//!
//! A new kernel is a file with the few functions of [`Kernel`], and a type for each thing that it may do in another way than
//! most: compute once what is the same for all rays of an image ([`Preparation`]), test rays and triangles in pairs
//! ([`Paired`]), let hits that are certain wait until the nearest is known ([`Deferral`]), and keep corners in fewer bits
//! ([`Storage`]). One that does none of this says [`plain_kernel!`](crate::plain_kernel).

mod baldwin_weber;
mod bounding_box;
mod deferral;
mod double;
#[cfg(feature = "exact")]
mod exact;
mod id;
mod moller_trumbore;
mod packed;
mod paired;
mod preparation;
mod quantisation_grid;
mod quantised;
mod ray_form;
mod storage;
mod watertight;
// The exact kernel alone looks at all of the products.
#[cfg_attr(not(feature = "exact"), allow(dead_code))]
mod wide;

pub use baldwin_weber::BaldwinWeber;
pub use bounding_box::BoundingBox;
pub use deferral::{Deferral, Deferred};
pub use double::Double;
#[cfg(feature = "exact")]
pub use exact::Exact;
pub use id::KernelId;
pub use moller_trumbore::MollerTrumbore;
pub use packed::Packed;
pub use paired::{InPairs, Paired, Permuted};
pub use preparation::{Preparation, Prepared, Unprepared};
pub use quantisation_grid::QuantisationGrid;
pub use quantised::Quantised;
pub use ray_form::RayForm;
pub use storage::{Floats, Storage};
pub use watertight::Watertight;

use accel::{Corners, Ray, Surface};
use lanes::packet::{Lanes, Packet, Vec3Lanes};
use lanes::{ROW, Row, Scalar, Simd};
use std::cmp::Ordering;

/// A ray-triangle test.
pub trait Kernel: Copy + Default + Send + Sync + 'static {
    /// The kernel's name.
    const ID: KernelId;
    /// Rows of packed geometry for each group of [`ROW`] triangles.
    const ROWS: usize = 9;
    /// Whether geometry of extreme size is scaled by a power of two before the kernel sees it, since its products
    /// of coordinates would under- or overflow.
    const NORMALISED: bool = true;
    /// What is computed beforehand for rays with a point or a direction in common: the kernel itself if it implements
    /// [`Preparation`], else [`Unprepared`].
    type Preparation: Preparation<Self>;
    /// How the nearest hit is searched for: [`Immediate`], [`InPairs`] or [`Deferred`].
    type Search;
    /// How packed triangles are kept: [`Floats`] as packed here, or [`QuantisationGrid`].
    type Storage: Storage;
    /// What is computed once for a ray: nothing, if it is [`Ray`] itself.
    type One: RayForm;
    /// What its edges are made of, where that says how much rounding moves them. [`Kernel::pack`] then writes corners to the first
    /// nine rows.
    const EDGE_ERROR: Option<EdgeError> = None;

    /// Writes a triangle to lane `lane` of a group of [`Kernel::ROWS`] rows.
    #[inline(always)]
    fn pack(corners: &Corners, group: &mut [Row], lane: usize) {
        packed::pack_corners(corners, group, lane);
    }

    /// The corners of a packed triangle, or others with the same box; `None` where the rows don't hold them.
    #[inline(always)]
    fn corners(packed: Packed<'_>) -> Option<Corners> {
        Some(packed.corners())
    }

    /// Prepares one ray.
    #[inline(always)]
    fn one(ray: &Ray) -> Self::One {
        Self::One::one(ray)
    }

    /// Prepares `LANES` rays.
    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> Many<Self, S> {
        Self::One::many(s, rays)
    }

    /// One ray against `LANES` triangles from a lane on, with t up to `t_max`. Nobody looks at the answers of other
    /// lanes than those whose bits are `wanted`.
    fn triangles<S: Simd>(s: S, ray: &Self::One, packed: Packed<'_>, wanted: u32, t_max: f32) -> Lanes<S>;

    /// `LANES` rays against one triangle, with t up to `t_max`.
    fn rays<S: Simd>(s: S, rays: &Many<Self, S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S>;

    /// The order along the ray of the hits of two triangles that are reported at the same t; where equal, the lower
    /// number comes first.
    #[inline(always)]
    fn order(ray: &Ray, corners: impl FnOnce() -> [Corners; 2]) -> Ordering {
        let _ = (ray, corners);
        Ordering::Equal
    }

    /// One ray against one triangle.
    #[inline]
    fn test(ray: &Self::One, corners: &Corners, t_max: f32) -> Option<Surface> {
        const MAX_ROWS: usize = 16;
        const { assert!(Self::ROWS <= MAX_ROWS) };
        let mut group = [Row([0.0; ROW]); MAX_ROWS];
        Self::pack(corners, &mut group[..Self::ROWS], 0);
        let Lanes { hit, t, u, v } =
            Self::triangles(Scalar, ray, Packed::new(&group[..Self::ROWS], 0), 1, t_max);
        hit.then_some(Surface { t, u, v })
    }
}

/// What the signs depend on that a kernel finds for the three edge functions of a triangle and for their sum, so by how much they may
/// be wrong.
///
/// An edge function is the volume that an edge spans with a ray's origin and direction; in the plane of an image it is
/// J. Pineda's (*A Parallel Algorithm for Polygon Rasterization*, SIGGRAPH 1988).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeError {
    /// Differences of corners are multiplied, or signs are exact: [`accel::tolerance::EDGE`].
    Edge,
    /// Both ends of an edge are seen from the origin: [`accel::tolerance::CORNERS`].
    Corners,
}

/// `LANES` rays as kernel `K` wants them.
pub type Many<K, S> = <<K as Kernel>::One as RayForm>::Many<S>;

/// In an `impl` of [`Kernel`]: nothing is computed beforehand, tests are decided at once, corners are kept in `f32`.
#[macro_export]
macro_rules! plain_kernel {
    () => {
        type Preparation = $crate::kernel::Unprepared;
        type Search = $crate::kernel::Immediate;
        type Storage = $crate::kernel::Floats;
    };
}

/// Every test is decided at once.
#[derive(Clone, Copy, Debug)]
pub struct Immediate;

// Plain functions and no closures: only what is `#[inline(always)]` is sure to be compiled
// with the instruction set of its caller.

/// Writes three rows from lane `at` on.
#[inline(always)]
pub(crate) fn store_rows<S: Simd>(s: S, v: Vec3Lanes<S>, rows: &mut [Row], at: usize) {
    for (v, row) in v.into_iter().zip(rows) {
        s.store(v, &mut row.0[at..]);
    }
}

/// a − b
#[inline(always)]
pub(crate) fn sub3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [s.sub(a[0], b[0]), s.sub(a[1], b[1]), s.sub(a[2], b[2])]
}

/// ad − bc
#[inline(always)]
pub(crate) fn det2<S: Simd>(s: S, a: S::F, b: S::F, c: S::F, d: S::F) -> S::F {
    s.sub(s.mul(a, d), s.mul(b, c))
}

/// a × b
#[inline(always)]
pub(crate) fn cross3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [det2(s, a[1], a[2], b[1], b[2]), det2(s, a[2], a[0], b[2], b[0]), det2(s, a[0], a[1], b[0], b[1])]
}

/// a · b, summed from x to z
#[inline(always)]
pub(crate) fn dot3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> S::F {
    s.add(s.add(s.mul(a[0], b[0]), s.mul(a[1], b[1])), s.mul(a[2], b[2]))
}

/// The sum of the sizes of the components.
#[inline(always)]
pub(crate) fn size3<S: Simd>(s: S, v: Vec3Lanes<S>) -> S::F {
    s.add(s.add(s.abs(v[0]), s.abs(v[1])), s.abs(v[2]))
}

#[cfg(test)]
mod tests;
