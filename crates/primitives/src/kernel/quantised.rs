//! Corners of 16 bits a coordinate.

use super::{Immediate, Kernel, KernelId, MollerTrumbore, Preparation};
use accel::{Common, Ray};
use lanes::packet::{Lanes, Packet};
use lanes::{Row, Simd};

/// [`MollerTrumbore`] on corners that are rounded to a lattice of 2^16 places an axis over the whole scene, and kept so: half the
/// memory, and another mesh. A corner that triangles share is rounded to the same place for all, so what was closed stays closed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quantised;

type Test = MollerTrumbore;

impl Kernel for Quantised {
    const ID: KernelId = KernelId::Quantised;
    const QUANTISED: bool = true;
    type Prepared = Self;
    type Deferral = Immediate;
    type One = <Test as Kernel>::One;
    type Many<S: Simd> = <Test as Kernel>::Many<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Self::One {
        Test::one(ray)
    }

    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> Self::Many<S> {
        Test::many(s, rays)
    }

    #[inline(always)]
    fn triangles<S: Simd>(
        s: S,
        ray: &Self::One,
        group: &[Row],
        at: usize,
        wanted: u32,
        t_max: f32,
    ) -> Lanes<S> {
        Test::triangles(s, ray, group, at, wanted, t_max)
    }

    #[inline(always)]
    fn rays<S: Simd>(
        s: S,
        rays: &<Self as Kernel>::Many<S>,
        group: &[Row],
        lane: usize,
        t_max: S::F,
    ) -> Lanes<S> {
        Test::rays(s, rays, group, lane, t_max)
    }
}

impl Preparation<Self> for Quantised {
    const ROWS: usize = <Test as Preparation<Test>>::ROWS;

    #[inline(always)]
    fn prepare<S: Simd>(s: S, common: &Common, group: &[Row], at: usize, rows: &mut [Row]) {
        Test::prepare(s, common, group, at, rows);
    }

    #[inline(always)]
    fn rays_prepared<S: Simd>(
        s: S,
        rays: &<Self as Kernel>::Many<S>,
        common: &Common,
        group: &[Row],
        rows: &[Row],
        lane: usize,
        t_max: S::F,
    ) -> Lanes<S> {
        Test::rays_prepared(s, rays, common, group, rows, lane, t_max)
    }
}
