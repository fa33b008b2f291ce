//! Which rays single precision is enough for.

use accel::tolerance::{NEAR, pad_of};
use accel::{Aabb, Vec3};
use lanes::Simd;
use lanes::packet::Packet;

/// A scene's place and size.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// By how much boxes are padded.
    pub pad: f32,
    center: Vec3,
    /// How far from the centre, on each axis, the origin of a near ray is at most; below 0 where no ray is near.
    near: f32,
}

/// Scenes and directions as long as this, or its reciprocal, at most: their squares and products are normal numbers.
const USUAL: f32 = (1u32 << 30) as f32;

impl Frame {
    /// Of a scene with these bounds.
    pub fn of(bounds: &Aabb) -> Self {
        let pad = pad_of(bounds);
        if bounds.is_empty() {
            return Self { pad, center: Vec3::ZERO, near: -1.0 };
        }
        let extent = bounds.extent().max_element();
        let near = if (1.0 / USUAL..=USUAL).contains(&extent) { NEAR * extent } else { -1.0 };
        Self { pad, center: bounds.center(), near }
    }

    /// The rays whose hits `f32` gives within half the padding: see [`accel::tolerance::NEAR`].
    #[inline(always)]
    pub fn near<S: Simd>(&self, s: S, rays: &Packet<S>) -> S::M {
        let (limit, usual) = (s.splat(self.near), s.splat(USUAL));
        let (mut near, mut most) = (s.mask(u32::MAX), s.splat(0.0));
        for axis in 0..3 {
            let away = s.abs(s.sub(rays.origin[axis], s.splat(self.center[axis])));
            let length = s.abs(rays.direction[axis]);
            near = s.and(near, s.and(s.le(away, limit), s.le(length, usual)));
            most = s.max(most, length);
        }
        s.and(near, s.le(s.splat(1.0 / USUAL), most))
    }
}
