//! A test whose every decision is the true one, at the usual cost of one in `f32`.
//!
//! Stages, each leaving to the next what it can't tell for certain:
//!
//! 1. [`reject`]: Möller and Trumbore's products in `f32` with an error bound, in lanes. Nearly all
//!    triangles tested are missed, and nearly all misses end here. Hits that are certain, with bounds of t that tell which
//!    is the nearest, wait until the ray is done ([`Deferral`]).
//! 2. [`decide`]: the same products in `f64` with an error bound. It settles hits, and rounds t correctly where
//!    its bound leaves one `f32` only ([`meeting`]). Of hits that were certain there is nothing but t to be found ([`round`]).
//! 3. [`signs`]: rays through an edge or a corner, by signs without error.
//! 4. [`quotient`]: t itself without error. Ranges that begin or end at the hit, and t's halfway between two `f32`,
//!    come here.
//!
//! What counts as a hit: the triangle is closed, and hit from either side; so is the range of t. A ray in the
//! triangle's plane hits nothing, and nothing hits a triangle without area or one whose numbers aren't finite.
//!
//! t is the true one correctly rounded. Rounding keeps order, so of two hits the one reported at the lower t is the
//! nearer one; hits reported at the same t are put in order by exact quotients unless they are of one edge or corner
//! ([`Kernel::order`]).
//!
//! The idea of stages is that of J. R. Shewchuk, *Adaptive Precision Floating-Point
//! Arithmetic and Fast Robust Geometric Predicates*, Discrete & Computational Geometry 18(3), 1997.

mod decide;
mod meeting;
mod quotient;
mod reject;
mod round;
mod signs;

#[cfg(test)]
mod strategies;
#[cfg(test)]
mod tests;

use super::packed::pack_corners;
use super::wide::{OneEach, OneRay, OneTriangle};
use super::{
    Corners, Deferral, Deferred, EdgeError, Floats, Kernel, KernelId, Packed, Permuted, Preparation,
    Prepared, RayForm,
};
use accel::{Common, Ray};
use lanes::packet::RayRows;
use lanes::packet::{Bounds, Lanes, Packet, Vec3Lanes};
use lanes::{Row, Scalar, Simd};
use quotient::Quotient;
use signs::{Place, in_one_slice_plane, meet_at_corner, place, same_point};
use std::cmp::Ordering;

/// The exact test.
/// u and v are right to about one unit in the last place of 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact;

/// The row of the edges' largest components.
const LENGTH_ROW: usize = 9;

/// A ray and the size of its direction.
#[derive(Clone, Copy)]
pub struct Spanned {
    ray: Ray,
    span: reject::Span<Scalar>,
}

/// [`Spanned`] in lanes.
#[derive(Clone, Copy)]
pub struct SpannedLanes<S: Simd> {
    rays: Packet<S>,
    span: reject::Span<S>,
}

impl RayForm for Spanned {
    type Many<S: Simd> = SpannedLanes<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Self {
        Spanned { ray: *ray, span: reject::Span::of(Scalar, ray.origin.to_array(), ray.direction.to_array()) }
    }

    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> SpannedLanes<S> {
        SpannedLanes { rays: *rays, span: reject::Span::of(s, rays.origin, rays.direction) }
    }
}

impl Kernel for Exact {
    const ID: KernelId = KernelId::Exact;
    const NORMALISED: bool = false;
    /// The corners, and the largest component of the edges.
    const ROWS: usize = 10;
    type Preparation = Self;
    type Search = Deferred;
    type Storage = Floats;
    type One = Spanned;
    const EDGE_ERROR: Option<EdgeError> = Some(EdgeError::Edge);

    #[inline(always)]
    fn pack(corners: &Corners, group: &mut [Row], lane: usize) {
        pack_corners(corners, group, lane);
        group[LENGTH_ROW].0[lane] = reject::length_of(corners);
    }

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Spanned, packed: Packed<'_>, wanted: u32, t_max: f32) -> Lanes<S> {
        let bounds = Self::bounds_one(s, ray, packed, wanted, t_max);
        Self::decide_one(s, ray, packed, wanted & s.bits(bounds.undecided), t_max)
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &SpannedLanes<S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        let undecided = s.bits(Self::bounds(s, rays, packed, t_max).undecided);
        Self::decide(s, rays, packed, undecided, t_max)
    }

    #[cold]
    fn order(ray: &Ray, corners: impl FnOnce() -> [Corners; 2]) -> Ordering {
        let [a, b] = &corners();
        if Self::at_one_t(a, b) {
            return Ordering::Equal;
        }
        if meet_at_corner(ray, a, b) {
            return Ordering::Equal;
        }
        if let (Place::Inside(on_a), Place::Inside(on_b)) = (place(ray, a), place(ray, b))
            && same_point((a, on_a), (b, on_b))
        {
            return Ordering::Equal;
        }
        match (Quotient::of(ray, a), Quotient::of(ray, b)) {
            (Some(a), Some(b)) => a.cmp(&b),
            // Neither is a hit.
            _ => Ordering::Equal,
        }
    }
}

impl Preparation<Self> for Exact {
    const ROWS: usize = reject::PREPARED_ROWS;

    #[inline(always)]
    fn prepare<S: Simd>(s: S, common: &Common, packed: Packed<'_>, rows: &mut [Row]) {
        reject::prepare(s, common, packed, rows);
    }

    #[inline(always)]
    fn rays_prepared<S: Simd>(s: S, rays: &SpannedLanes<S>, prepared: Prepared<'_>, t_max: S::F) -> Lanes<S> {
        let bounds = Self::bounds_prepared(s, rays, prepared, t_max);
        Self::decide(s, rays, prepared.packed, s.bits(bounds.undecided), t_max)
    }
}

impl Permuted for Exact {
    #[inline(always)]
    fn permuted<S: Simd>(s: S, rays: &SpannedLanes<S>, at: S::U) -> SpannedLanes<S> {
        SpannedLanes { rays: rays.rays.permuted(s, at), span: rays.span.permuted(s, at) }
    }
}

impl Deferral for Exact {
    #[inline(always)]
    fn bounds_one<S: Simd>(s: S, ray: &Spanned, packed: Packed<'_>, wanted: u32, t_max: f32) -> Bounds<S> {
        let rays = Packet::splat(s, &ray.ray);
        let length = s.load(&packed.group[LENGTH_ROW].0[packed.lane..]);
        let span = ray.span.splat(s);
        reject::bounds(s, &rays, &span, packed.load_corners(s), length, wanted, s.splat(t_max))
    }

    #[inline(always)]
    fn decide_one<S: Simd>(s: S, ray: &Spanned, packed: Packed<'_>, undecided: u32, t_max: f32) -> Lanes<S> {
        if undecided == 0 {
            return nothing(s);
        }
        let pairs = OneRay::new(&ray.ray, packed, S::LANES);
        in_range(s, decide::decide(s, &pairs, undecided), &Packet::splat(s, &ray.ray), s.splat(t_max))
    }

    #[inline(always)]
    fn bounds<S: Simd>(s: S, rays: &SpannedLanes<S>, packed: Packed<'_>, t_max: S::F) -> Bounds<S> {
        let length = s.splat(packed.group[LENGTH_ROW].0[packed.lane]);
        let corners = packed.splat_corners(s);
        reject::bounds(s, &rays.rays, &rays.span, corners, length, u32::MAX, t_max)
    }

    const SIZE_ROW: usize = LENGTH_ROW;

    #[inline(always)]
    fn sizes<S: Simd>(s: S, corners: [Vec3Lanes<S>; 3]) -> S::F {
        reject::lengths(s, corners)
    }

    #[inline(always)]
    fn bounds_each<S: Simd>(
        s: S,
        rays: &SpannedLanes<S>,
        corners: [Vec3Lanes<S>; 3],
        sizes: S::F,
        wanted: u32,
        t_max: S::F,
    ) -> Bounds<S> {
        reject::bounds(s, &rays.rays, &rays.span, corners, sizes, wanted, t_max)
    }

    #[inline(always)]
    fn decide<S: Simd>(
        s: S,
        rays: &SpannedLanes<S>,
        packed: Packed<'_>,
        undecided: u32,
        t_max: S::F,
    ) -> Lanes<S> {
        if undecided == 0 {
            return nothing(s);
        }
        // Else the compiler loads the corners once for here and for the rejection, and by a gather.
        let group = std::hint::black_box(packed.group);
        let rows = RayRows::of(s, &rays.rays);
        let pairs = OneTriangle::new(&rows, Packed { group, ..packed });
        in_range(s, decide::decide(s, &pairs, undecided), &rays.rays, t_max)
    }

    #[inline]
    fn at_one_t(a: &Corners, b: &Corners) -> bool {
        a == b || in_one_slice_plane(a, b)
    }

    #[inline(always)]
    fn resolve<S: Simd>(s: S, rays: &Packet<S>, corners: [Vec3Lanes<S>; 3], deferred: u32) -> Lanes<S> {
        round::round(s, &OneEach::new(s, rays, corners), deferred)
    }

    #[inline(always)]
    fn bounds_prepared<S: Simd>(
        s: S,
        rays: &SpannedLanes<S>,
        prepared: Prepared<'_>,
        t_max: S::F,
    ) -> Bounds<S> {
        reject::bounds_prepared(s, &rays.rays, &rays.span, prepared, t_max)
    }
}

#[inline(always)]
fn nothing<S: Simd>(s: S) -> Lanes<S> {
    let zero = s.splat(0.0);
    Lanes { hit: s.mask(0), t: zero, u: zero, v: zero }
}

/// Where t is equal to an end of the ray's own range, it has been compared exactly.
#[inline(always)]
fn in_range<S: Simd>(s: S, lanes: Lanes<S>, ray: &Packet<S>, t_max: S::F) -> Lanes<S> {
    let within = s.and(s.le(ray.t_min, lanes.t), s.le(lanes.t, t_max));
    Lanes { hit: s.and(lanes.hit, within), ..lanes }
}
