//! Möller and Trumbore's test in `f64`: the cheap way to be right nearly always.

use super::wide::Inputs;
use super::{Kernel, KernelId, load_corners, splat_corners};
use crate::Ray;
use crate::packet::{Lanes, Packet, Vec3Lanes};
use crate::simd::{ROW, Row, Simd};

/// [`super::MollerTrumbore`] with every operation in `f64`. Products of three `f32`
/// neither under- nor overflow there, so scale makes no difference.
#[derive(Clone, Copy, Debug, Default)]
pub struct Double;

impl Kernel for Double {
    const ID: KernelId = KernelId::Double;
    type One = Ray;
    type Many<S: Simd> = Packet<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Ray {
        *ray
    }

    #[inline(always)]
    fn many<S: Simd>(_: S, rays: &Packet<S>) -> Packet<S> {
        *rays
    }

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Ray, group: &[Row], at: usize, t_max: f32) -> Lanes<S> {
        test(s, &Packet::splat(s, ray), &load_corners(s, group, at), s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &Packet<S>, group: &[Row], lane: usize, t_max: S::F) -> Lanes<S> {
        test(s, rays, &splat_corners(s, group, lane), t_max)
    }
}

#[inline(always)]
fn test<S: Simd>(s: S, ray: &Packet<S>, corners: &[Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
    let inputs = Inputs::of(s, ray, corners);
    let mut rows = [[0.0; ROW]; 3];
    let mut inside = [0.0; ROW];
    for lane in 0..S::LANES {
        let products = inputs.products(lane);
        let [u, v, t] = products.scaled.map(|scaled| scaled / products.det);
        // A zero determinant makes u or v infinite or NaN.
        let within = (0.0 <= u) & (0.0 <= v) & (u + v <= 1.0);
        inside[lane] = f32::from(u8::from(within));
        rows[0][lane] = t as f32;
        rows[1][lane] = u as f32;
        rows[2][lane] = v as f32;
    }
    let [t, u, v] = rows.map(|row| s.load(&row));
    let inside = s.lt(s.splat(0.0), s.load(&inside));
    // The range is that of the rounded t, so that the order of tests never shows.
    let in_range = s.and(s.le(ray.t_min, t), s.le(t, t_max));
    Lanes { hit: s.and(inside, in_range), t, u, v }
}
