//! Corners of 16 bits a coordinate.

use super::{
    EdgeError, Immediate, Kernel, KernelId, Many, MollerTrumbore, Packed, Preparation, Prepared,
    QuantisationGrid,
};
use accel::Common;
use lanes::packet::Lanes;
use lanes::{Row, Simd};

/// [`MollerTrumbore`] on corners that are rounded to a grid of 2^16 places an axis over the whole scene, and kept so: half the
/// memory, and another mesh. A corner that triangles share is rounded to the same place for all, so what was closed stays closed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quantised;

type Test = MollerTrumbore;

impl Kernel for Quantised {
    const ID: KernelId = KernelId::Quantised;
    type Preparation = Self;
    type Search = Immediate;
    type Storage = QuantisationGrid;
    type One = <Test as Kernel>::One;
    const EDGE_ERROR: Option<EdgeError> = Some(EdgeError::Edge);

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Self::One, packed: Packed<'_>, wanted: u32, t_max: f32) -> Lanes<S> {
        Test::triangles(s, ray, packed, wanted, t_max)
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &Many<Self, S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        Test::rays(s, rays, packed, t_max)
    }
}

impl Preparation<Self> for Quantised {
    const ROWS: usize = <Test as Preparation<Test>>::ROWS;

    #[inline(always)]
    fn prepare<S: Simd>(s: S, common: &Common, packed: Packed<'_>, rows: &mut [Row]) {
        Test::prepare(s, common, packed, rows);
    }

    #[inline(always)]
    fn rays_prepared<S: Simd>(s: S, rays: &Many<Self, S>, prepared: Prepared<'_>, t_max: S::F) -> Lanes<S> {
        Test::rays_prepared(s, rays, prepared, t_max)
    }
}
