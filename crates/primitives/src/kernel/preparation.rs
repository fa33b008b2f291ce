//! The capability of computing beforehand what rays with a point or a direction in common share.

use super::{Kernel, Many, Packed};
use accel::Common;
use lanes::packet::Lanes;
use lanes::{Row, Simd};

/// A packed triangle, and what was computed beforehand.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<'a> {
    /// What the rays have in common.
    pub common: &'a Common,
    /// The triangle.
    pub packed: Packed<'a>,
    /// What [`Preparation::prepare`] wrote for its group.
    pub rows: &'a [Row],
}

/// What kernel `K` computes once for all rays of an image.
pub trait Preparation<K: Kernel>: 'static {
    /// Rows of values for each group that [`Preparation::prepare`] computes.
    const ROWS: usize;

    /// Computes, for `LANES` triangles from a lane on, whatever is the same for all rays with this in common.
    fn prepare<S: Simd>(s: S, common: &Common, packed: Packed<'_>, rows: &mut [Row]);

    /// [`Kernel::rays`] for a prepared triangle: the same operations on the same operands, those that don't depend on
    /// the ray done before.
    fn rays_prepared<S: Simd>(s: S, rays: &Many<K, S>, prepared: Prepared<'_>, t_max: S::F) -> Lanes<S>;
}

/// Nothing is computed beforehand.
#[derive(Clone, Copy, Debug)]
pub struct Unprepared;

impl<K: Kernel> Preparation<K> for Unprepared {
    const ROWS: usize = 0;

    #[inline(always)]
    fn prepare<S: Simd>(_: S, _: &Common, _: Packed<'_>, _: &mut [Row]) {}

    #[inline(always)]
    fn rays_prepared<S: Simd>(s: S, rays: &Many<K, S>, prepared: Prepared<'_>, t_max: S::F) -> Lanes<S> {
        K::rays(s, rays, prepared.packed, t_max)
    }
}
