//! What is known of a whole mesh when its triangles are tested.

use super::{lawful, pad_of};
use crate::kernel::Corners;
use crate::packet::{Common, Packet};
use crate::simd::Simd;
use crate::{Aabb, Mesh, Ray, Vec3};

/// What the law of [`super::Objects`] needs to know of the whole mesh, and the scale at which
/// kernels see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) pad: f32,
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
    pub(super) fn of(mesh: &Mesh, normalised: bool) -> Self {
        let bounds = mesh.bounds();
        let pad = pad_of(&bounds);
        if bounds.is_empty() {
            return Self { pad, center: Vec3::ZERO, near: 0.0, scale: 1.0 };
        }
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let scale = if normalised { scale_for(largest) } else { 1.0 };
        Self { pad, center: bounds.center(), near: 4.0 * bounds.extent().max_element(), scale }
    }

    #[inline(always)]
    pub(super) fn is_near(&self, origin: Vec3) -> bool {
        (origin - self.center).abs().max_element() <= self.near
    }

    /// Whether a hit keeps the law of [`Objects`].
    #[inline]
    pub(super) fn lawful(&self, corners: &Corners, ray: &Ray, near: bool, t: f32) -> bool {
        (near && self.plainly_lawful(corners, ray, t))
            || lawful(&Aabb::of_points(*corners).padded(self.pad), ray, t)
    }

    /// A cheaper test that implies `lawful` for near rays: the hit's position relative to the first corner,
    /// rounded, lies in the box padded by half.
    #[inline]
    fn plainly_lawful(&self, corners: &Corners, ray: &Ray, t: f32) -> bool {
        let [a, b, c] = *corners;
        let half = Vec3::splat(self.pad * 0.5);
        let position = (ray.origin - a) + ray.direction * t;
        let (edge1, edge2) = (b - a, c - a);
        let low = edge1.min(edge2).min(Vec3::ZERO) - half;
        let high = edge1.max(edge2).max(Vec3::ZERO) + half;
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

/// [`Frame::plainly_lawful`] in lanes.
#[inline(always)]
pub(super) fn plainly_lawful<S: Simd>(
    s: S,
    frame: &Frame,
    corners: &Corners,
    rays: &Packet<S>,
    t: S::F,
) -> S::M {
    let [a, b, c] = *corners;
    let half = Vec3::splat(frame.pad * 0.5);
    let (edge1, edge2) = (b - a, c - a);
    let low = edge1.min(edge2).min(Vec3::ZERO) - half;
    let high = edge1.max(edge2).max(Vec3::ZERO) + half;
    let mut all = s.mask(u32::MAX);
    for axis in 0..3 {
        let from_a = s.sub(rays.origin[axis], s.splat(a[axis]));
        let position = s.add(from_a, s.mul(rays.direction[axis], t));
        all = s.and(all, s.and(s.le(s.splat(low[axis]), position), s.le(position, s.splat(high[axis]))));
    }
    all
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
