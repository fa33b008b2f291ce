//! Tests of kinds that are packed in rows of 16, in single precision: one ray against `LANES` objects, or one object against
//! `LANES` rays, by the same operations.

mod cone;
mod sphere;
mod triangle;

pub use cone::Cones;
pub use sphere::Spheres;
pub use triangle::Triangles;

use accel::{Ray, Solid, Surface};
use lanes::packet::{Lanes, Packet, Vec3Lanes, permute3};
use lanes::{Row, Simd};

/// More rows than any kind has.
pub const MAX_ROWS: usize = 15;

/// The numbers of `LANES` objects.
pub type Values<S> = [<S as Simd>::F; MAX_ROWS];

/// A ray and what is the same for all objects.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<F> {
    pub origin: [F; 3],
    pub direction: [F; 3],
    /// One over the direction's square.
    pub inverse: F,
    pub t_min: F,
    /// Half of what boxes are padded by.
    pub half_pad: F,
}

impl<F: Copy> Prepared<F> {
    #[inline(always)]
    pub fn of<S: Simd<F = F>>(s: S, rays: &Packet<S>, pad: f32) -> Self {
        let inverse = s.div(s.splat(1.0), dot(s, rays.direction, rays.direction));
        let half_pad = s.splat(0.5 * pad);
        Self { origin: rays.origin, direction: rays.direction, inverse, t_min: rays.t_min, half_pad }
    }
}

impl<F: Copy> Prepared<F> {
    /// The rays in the lanes whose numbers `at` holds.
    #[inline(always)]
    pub fn permuted<S: Simd<F = F>>(&self, s: S, at: S::U) -> Self {
        Self {
            origin: permute3(s, self.origin, at),
            direction: permute3(s, self.direction, at),
            inverse: s.permute(self.inverse, at),
            t_min: s.permute(self.t_min, at),
            half_pad: self.half_pad,
        }
    }
}

impl Prepared<f32> {
    /// In all lanes.
    #[inline(always)]
    pub fn splat<S: Simd>(&self, s: S) -> Prepared<S::F> {
        let all = |v: [f32; 3]| [s.splat(v[0]), s.splat(v[1]), s.splat(v[2])];
        Prepared {
            origin: all(self.origin),
            direction: all(self.direction),
            inverse: s.splat(self.inverse),
            t_min: s.splat(self.t_min),
            half_pad: s.splat(self.half_pad),
        }
    }
}

/// What a test found.
#[derive(Clone, Copy)]
pub struct Found<S: Simd> {
    /// Hits with t in range. Both zeros are one.
    pub lanes: Lanes<S>,
    /// Those whose place, as it is rounded, lies in the object's box padded by half: for near rays they satisfy the
    /// hit-in-padded-bounds invariant.
    pub plain: S::M,
}

/// A kind that is packed.
pub trait Packing: 'static {
    /// How many numbers an object has.
    const ROWS: usize;

    /// Whether the rows serve the exact test as well.
    const HAS_EXACT: bool = false;

    /// The numbers of a solid, if it is of this kind.
    fn numbers(solid: &Solid) -> Option<[f32; MAX_ROWS]>;

    /// Tests rays against objects in as many lanes, with t up to `t_max`.
    fn test<S: Simd>(s: S, ray: &Prepared<S::F>, values: &Values<S>, t_max: S::F) -> Found<S>;
}

/// `LANES` objects of a group from a lane on.
#[inline(always)]
pub fn load<K: Packing, S: Simd>(s: S, group: &[Row], lane: usize) -> Values<S> {
    let mut values = [s.splat(0.0); MAX_ROWS];
    for (value, row) in values.iter_mut().zip(&group[..K::ROWS]) {
        *value = s.load(&row.0[lane..]);
    }
    values
}

/// One object of a group in all lanes.
#[inline(always)]
pub fn splat<K: Packing, S: Simd>(s: S, group: &[Row], lane: usize) -> Values<S> {
    let mut values = [s.splat(0.0); MAX_ROWS];
    for (value, row) in values.iter_mut().zip(&group[..K::ROWS]) {
        *value = s.splat(row.0[lane]);
    }
    values
}

/// One object against one ray.
#[inline(always)]
pub fn one<K: Packing>(
    numbers: &[f32; MAX_ROWS],
    ray: &Ray,
    pad: f32,
    t_max: f32,
) -> Option<(Surface, bool)> {
    let prepared = Prepared::of(lanes::Scalar, &Packet::splat(lanes::Scalar, ray), pad);
    let found = K::test(lanes::Scalar, &prepared, numbers, t_max);
    let Lanes { hit, t, u, v } = found.lanes;
    hit.then_some((Surface { t, u, v }, found.plain))
}

#[inline(always)]
fn dot<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> S::F {
    s.add(s.add(s.mul(a[0], b[0]), s.mul(a[1], b[1])), s.mul(a[2], b[2]))
}

/// a + b·t
#[inline(always)]
fn along<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>, t: S::F) -> Vec3Lanes<S> {
    [s.add(a[0], s.mul(b[0], t)), s.add(a[1], s.mul(b[1], t)), s.add(a[2], s.mul(b[2], t))]
}

#[inline(always)]
fn sub3<S: Simd>(s: S, a: Vec3Lanes<S>, b: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [s.sub(a[0], b[0]), s.sub(a[1], b[1]), s.sub(a[2], b[2])]
}

/// The first of a way in and a way out that is in the ray's range.
#[inline(always)]
fn first<S: Simd>(s: S, enters: S::F, leaves: S::F, t_min: S::F, t_max: S::F) -> (S::M, S::F) {
    let t = s.add(s.select(s.le(t_min, enters), enters, leaves), s.splat(0.0));
    (s.and(s.le(t_min, t), s.le(t, t_max)), t)
}
