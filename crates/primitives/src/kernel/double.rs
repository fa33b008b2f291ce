//! Möller and Trumbore's test in `f64`: the cheap way to be right nearly always.

use super::wide::{OneRay, OneTriangle, Pairs, Products};
use super::{EdgeError, Kernel, KernelId, Packed, RayForm};
use accel::Ray;
use lanes::packet::RayRows;
use lanes::packet::{Lanes, Packet};
use lanes::{ROW, Simd};

/// [`super::MollerTrumbore`] with every operation in `f64`. Products of three `f32`
/// neither under- nor overflow there, so scale makes no difference.
#[derive(Clone, Copy, Debug, Default)]
pub struct Double;

/// A ray that is read from memory, as [`Rays`] are.
#[derive(Clone, Copy, Debug)]
pub struct InMemory(Ray);

/// Rays in lanes and in memory.
#[derive(Clone, Copy)]
pub struct Rays<S: Simd> {
    t_min: S::F,
    rows: RayRows,
}

impl RayForm for InMemory {
    type Many<S: Simd> = Rays<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Self {
        Self(*ray)
    }

    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> Rays<S> {
        Rays { t_min: rays.t_min, rows: RayRows::of(s, rays) }
    }
}

impl Kernel for Double {
    const ID: KernelId = KernelId::Double;
    const NORMALISED: bool = false;
    crate::plain_kernel!();
    type One = InMemory;
    const EDGE_ERROR: Option<EdgeError> = Some(EdgeError::Edge);

    #[inline(always)]
    fn triangles<S: Simd>(
        s: S,
        InMemory(ray): &InMemory,
        packed: Packed<'_>,
        _: u32,
        t_max: f32,
    ) -> Lanes<S> {
        test(s, &OneRay::new(ray, packed, S::LANES), s.splat(ray.t_min), s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &Rays<S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        test(s, &OneTriangle::new(&rays.rows, packed), rays.t_min, t_max)
    }
}

#[inline(always)]
fn test<S: Simd>(s: S, pairs: &impl Pairs, t_min: S::F, t_max: S::F) -> Lanes<S> {
    let mut rows = [[0.0; ROW]; 4];
    let [t_row, u_row, v_row, inside] = &mut rows;
    for lane in 0..S::LANES {
        let Products { det, scaled: [u, v, t], .. } = Products::of(&pairs.ray(lane), &pairs.corners(lane));
        let reciprocal = 1.0 / det;
        let (u, v) = (u * reciprocal, v * reciprocal);
        // A zero determinant makes u or v infinite or NaN.
        let within = (0.0 <= u) & (0.0 <= v) & (u + v <= 1.0);
        t_row[lane] = (t * reciprocal) as f32;
        u_row[lane] = u as f32;
        v_row[lane] = v as f32;
        inside[lane] = if within { 1.0 } else { 0.0 };
    }
    let t = s.load(&rows[0]);
    let inside = s.lt(s.splat(0.0), s.load(&rows[3]));
    // The range is that of the rounded t, so that the order of tests never shows.
    let in_range = s.and(s.le(t_min, t), s.le(t, t_max));
    Lanes { hit: s.and(inside, in_range), t, u: s.load(&rows[1]), v: s.load(&rows[2]) }
}
