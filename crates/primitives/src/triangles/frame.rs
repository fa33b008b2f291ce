//! What is known of a whole mesh when its triangles are tested.

use crate::kernel::{store_rows, sub3};
use accel::tolerance::{NEAR, holds, pad_of};
use accel::{Aabb, Common, Corners, Ray, Vec3};
use lanes::packet::{Packet, Vec3Lanes, splat3};
use lanes::{Row, Simd};

/// What the hit-in-padded-bounds invariant of [`accel::Objects`] needs to know of the whole mesh, and the scale at which
/// kernels see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// By how much boxes are padded on every side.
    pub(super) pad: f32,
    /// The middle of the scene.
    pub(super) center: Vec3,
    /// Rays whose origin is no farther than this from the centre, on each axis, have hits whose position
    /// `f32` gives well within half the padding.
    pub(super) near: f32,
    /// A power of two, so that scaling is exact. It is 1 unless products of three coordinates come near the ends of
    /// the range of `f32`.
    pub(super) scale: f32,
}

/// Largest coordinates between the reciprocal of this and this are left as they are.
const USUAL: f32 = (1u32 << 30) as f32;

/// The power of two that brings a mesh with this largest coordinate near the size of 1.
fn scale_for(largest: f32) -> f32 {
    if largest == 0.0 || (1.0 / USUAL..=USUAL).contains(&largest) {
        return 1.0;
    }
    let biased = (largest.to_bits() >> 23).clamp(1, 253);
    f32::from_bits((254 - biased) << 23)
}

impl Frame {
    /// `normalised` says whether kernels see the mesh near the size of 1.
    pub(super) fn of(bounds: &Aabb, normalised: bool) -> Self {
        let pad = pad_of(bounds);
        if bounds.is_empty() {
            return Self { pad, center: Vec3::ZERO, near: 0.0, scale: 1.0 };
        }
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let scale = if normalised { scale_for(largest) } else { 1.0 };
        Self { pad, center: bounds.center(), near: NEAR * bounds.extent().max_element(), scale }
    }

    /// Whether hits of rays from there that are in the triangle for certain, with t rounded correctly and normal, satisfy the hit-in-padded-bounds invariant plainly:
    /// on each axis the origin is at most 4.5 extents E from the first corner, and so is the hit. Rounding t, the relative origin, the
    /// product and the sum moves the position by 15E·2^-24 in all, a quarter of half the padding E·2^-17.
    #[inline(always)]
    pub(super) fn is_near(&self, origin: Vec3) -> bool {
        (origin - self.center).abs().max_element() <= self.near
    }

    /// Whether a hit satisfies the hit-in-padded-bounds invariant.
    #[inline]
    pub(super) fn holds(&self, corners: &Corners, ray: &Ray, near: bool, t: f32) -> bool {
        (near && self.plainly_holds(corners, ray, t))
            || holds(&Aabb::of_points(*corners).padded(self.pad), ray, t)
    }

    /// A cheaper test that implies [`Frame::holds`] for near rays: the hit's position relative to the first corner,
    /// rounded, lies in the box padded by half.
    #[inline]
    fn plainly_holds(&self, corners: &Corners, ray: &Ray, t: f32) -> bool {
        let Limits { first, low, high } = Limits::of(self, corners);
        let position = (ray.origin - first) + ray.direction * t;
        low.cmple(position).all() && position.cmple(high).all()
    }

    /// A ray as kernels see it. t stays as it is.
    #[inline(always)]
    pub(super) fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: ray.origin * self.scale, direction: ray.direction * self.scale, ..*ray }
    }

    /// Rays as kernels see them.
    #[inline(always)]
    pub(super) fn packet<S: Simd>(&self, s: S, rays: &Packet<S>) -> Packet<S> {
        if self.scale == 1.0 {
            return *rays;
        }
        let scale = s.splat(self.scale);
        let ([x, y, z], [dx, dy, dz]) = (rays.origin, rays.direction);
        Packet {
            origin: [s.mul(x, scale), s.mul(y, scale), s.mul(z, scale)],
            direction: [s.mul(dx, scale), s.mul(dy, scale), s.mul(dz, scale)],
            ..*rays
        }
    }

    /// What rays have in common, as kernels see it.
    #[inline(always)]
    pub(super) fn common(&self, common: &Common) -> Common {
        match *common {
            Common::Direction(direction) => Common::Direction(direction * self.scale),
            Common::Origin(origin) => Common::Origin(origin * self.scale),
        }
    }

    /// Corners as kernels see them.
    #[inline(always)]
    pub(super) fn corners(&self, corners: &Corners) -> Corners {
        [corners[0] * self.scale, corners[1] * self.scale, corners[2] * self.scale]
    }
}

/// Within what a hit's position relative to the first corner, rounded, satisfies the invariant plainly.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    first: Vec3,
    low: Vec3,
    high: Vec3,
}

/// Rows that hold [`Limits`] of 16 triangles.
pub(super) const LIMIT_ROWS: usize = 9;

impl Limits {
    /// Those of [`Frame::plainly_holds`].
    #[inline(always)]
    pub(super) fn of(frame: &Frame, [a, b, c]: &Corners) -> Self {
        let half = Vec3::splat(frame.pad * 0.5);
        let (edge1, edge2) = (*b - *a, *c - *a);
        let low = edge1.min(edge2).min(Vec3::ZERO) - half;
        let high = edge1.max(edge2).max(Vec3::ZERO) + half;
        Self { first: *a, low, high }
    }

    /// Writes those of triangles in lanes to rows from lane `at` on.
    #[inline(always)]
    pub(super) fn store<S: Simd>(
        s: S,
        frame: &Frame,
        corners: [Vec3Lanes<S>; 3],
        rows: &mut [Row],
        at: usize,
    ) {
        let LimitLanes { first, low, high } = LimitLanes::of(s, frame, corners);
        store_rows(s, first, &mut rows[0..3], at);
        store_rows(s, low, &mut rows[3..6], at);
        store_rows(s, high, &mut rows[6..9], at);
    }

    /// Those that were stored for a lane.
    #[inline(always)]
    pub(super) fn load(rows: &[Row], lane: usize) -> Self {
        let rows = &rows[..LIMIT_ROWS];
        let at = |row: usize| Vec3::new(rows[row].0[lane], rows[row + 1].0[lane], rows[row + 2].0[lane]);
        Self { first: at(0), low: at(3), high: at(6) }
    }

    /// The rays whose position at t lies within. Where those at two t's do, so do all between, for rounding keeps order.
    #[inline(always)]
    pub(super) fn hold<S: Simd>(&self, s: S, rays: &Packet<S>, t: S::F) -> S::M {
        let Self { first, low, high } = *self;
        LimitLanes { first: splat3(s, first), low: splat3(s, low), high: splat3(s, high) }.hold(s, rays, t)
    }
}

/// [`Limits`] of a triangle in each lane.
#[derive(Clone, Copy)]
pub(super) struct LimitLanes<S: Simd> {
    first: Vec3Lanes<S>,
    low: Vec3Lanes<S>,
    high: Vec3Lanes<S>,
}

impl<S: Simd> LimitLanes<S> {
    /// As [`Limits::of`].
    #[inline(always)]
    pub(super) fn of(s: S, frame: &Frame, [a, b, c]: [Vec3Lanes<S>; 3]) -> Self {
        let (half, zero) = (s.splat(frame.pad * 0.5), s.splat(0.0));
        let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
        let mut limits = Self { first: a, low: edge1, high: edge1 };
        for axis in 0..3 {
            limits.low[axis] = s.sub(s.min(s.min(edge1[axis], edge2[axis]), zero), half);
            limits.high[axis] = s.add(s.max(s.max(edge1[axis], edge2[axis]), zero), half);
        }
        limits
    }

    /// As [`Limits::hold`], each ray with the triangle in its lane.
    #[inline(always)]
    pub(super) fn hold(&self, s: S, rays: &Packet<S>, t: S::F) -> S::M {
        let mut all = s.mask(u32::MAX);
        for axis in 0..3 {
            let from_first = s.sub(rays.origin[axis], self.first[axis]);
            let position = s.add(from_first, s.mul(rays.direction[axis], t));
            all = s.and(all, s.and(s.le(self.low[axis], position), s.le(position, self.high[axis])));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_bring_extreme_meshes_near_one_and_leave_others() {
        for usual in [1.0, 3e-5, 1e7, 0.0] {
            assert_eq!(scale_for(usual), 1.0);
        }
        for e in [-126, -100, -31, 31, 100, 126] {
            let scaled = 1.5 * 2f32.powi(e) * scale_for(1.5 * 2f32.powi(e));
            assert_eq!(scaled, 1.5);
        }
        // Denormal, and too large for the reciprocal: as near as a power of two in `f32` can bring them.
        assert_eq!(scale_for(f32::from_bits(1)), 2f32.powi(126));
        assert_eq!(scale_for(f32::MAX), 2f32.powi(-126));
    }
}
