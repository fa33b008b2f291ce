//! The capability of telling what is certain before a test is decided.

use super::Kernel;
use accel::{Common, Corners, Ray};
use lanes::packet::{Bounds, Lanes, Packet};
use lanes::{ROW, Row, Scalar, Simd};
use std::cmp::Ordering;

/// What kernel `K` can tell of a test without deciding it.
///
/// Worth while where that is enough to find the nearest hit, and costs so much less than a decision that hits are better
/// decided when the nearest is known. A certain hit must lie in the triangle and its t, once decided, be correctly
/// rounded.
pub trait Deferral<K: Kernel>: 'static {
    /// Whether hits are deferred, and those of different triangles at the same reported t put in order by
    /// [`Deferral::order`]. Where not, nothing else here is called.
    const DEFERS: bool = true;

    /// What can be told of [`Kernel::triangles`], of the lanes `wanted`.
    fn triangles_bounds<S: Simd>(
        s: S,
        ray: &K::One,
        group: &[Row],
        at: usize,
        wanted: u32,
        t_max: f32,
    ) -> Bounds<S>;

    /// [`Kernel::triangles`] for the lanes `undecided` only; the others hold no hit.
    fn triangles_decided<S: Simd>(
        s: S,
        ray: &K::One,
        group: &[Row],
        at: usize,
        undecided: u32,
        t_max: f32,
    ) -> Lanes<S> {
        let lanes = K::triangles(s, ray, group, at, undecided, t_max);
        Lanes { hit: s.and(lanes.hit, s.mask(undecided)), ..lanes }
    }

    /// What can be told of [`Kernel::rays`].
    fn bounds<S: Simd>(s: S, rays: &K::Many<S>, group: &[Row], lane: usize, t_max: S::F) -> Bounds<S>;

    /// [`Deferral::bounds`] for rays with this in common, with the rows that the kernel's
    /// [`Preparation`](super::Preparation) wrote.
    fn bounds_prepared<S: Simd>(
        s: S,
        rays: &K::Many<S>,
        common: &Common,
        group: &[Row],
        rows: &[Row],
        lane: usize,
        t_max: S::F,
    ) -> Bounds<S>;

    /// [`Kernel::rays`] for the rays `undecided` only; the others hit nothing.
    #[inline(always)]
    fn decide<S: Simd>(
        s: S,
        rays: &K::Many<S>,
        group: &[Row],
        lane: usize,
        undecided: u32,
        t_max: S::F,
    ) -> Lanes<S> {
        let lanes = K::rays(s, rays, group, lane, t_max);
        Lanes { hit: s.and(lanes.hit, s.mask(undecided)), ..lanes }
    }

    /// Each of the rays `deferred` against the triangle in its own lane of a group that [`Kernel::pack`] wrote, at any t
    /// of the ray's range.
    #[inline(always)]
    fn resolve<S: Simd>(s: S, rays: &Packet<S>, group: &[Row], deferred: u32) -> Lanes<S> {
        let mut rows = [[0.0; ROW]; 3];
        let mut hits = 0;
        for lane in (0..S::LANES).filter(|lane| deferred >> lane & 1 != 0) {
            let ray = rays.ray(s, lane);
            let one = K::triangles(Scalar, &K::one(&ray), group, lane, 1, ray.t_max);
            hits |= u32::from(one.hit) << lane;
            (rows[0][lane], rows[1][lane], rows[2][lane]) = (one.t, one.u, one.v);
        }
        Lanes { hit: s.mask(hits), t: s.load(&rows[0]), u: s.load(&rows[1]), v: s.load(&rows[2]) }
    }

    /// The order along the ray of the hits of two triangles that are reported at the same t; where equal,
    /// the lower number comes first.
    fn order(ray: &Ray, a: &Corners, b: &Corners) -> Ordering;
}

/// Every test is decided at once.
#[derive(Clone, Copy, Debug)]
pub struct Immediate;

impl<K: Kernel> Deferral<K> for Immediate {
    const DEFERS: bool = false;

    #[inline(always)]
    fn triangles_bounds<S: Simd>(s: S, _: &K::One, _: &[Row], _: usize, _: u32, _: f32) -> Bounds<S> {
        Bounds::unknown(s)
    }

    #[inline(always)]
    fn bounds<S: Simd>(s: S, _: &K::Many<S>, _: &[Row], _: usize, _: S::F) -> Bounds<S> {
        Bounds::unknown(s)
    }

    #[inline(always)]
    fn bounds_prepared<S: Simd>(
        s: S,
        _: &K::Many<S>,
        _: &Common,
        _: &[Row],
        _: &[Row],
        _: usize,
        _: S::F,
    ) -> Bounds<S> {
        Bounds::unknown(s)
    }

    fn order(_: &Ray, _: &Corners, _: &Corners) -> Ordering {
        Ordering::Equal
    }
}
