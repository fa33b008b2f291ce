//! The capability of computing beforehand what rays with a point or a direction in common share.

use super::Kernel;
use accel::Common;
use lanes::packet::Lanes;
use lanes::{Row, Simd};

/// What kernel `K` computes once for all rays of an image.
pub trait Preparation<K: Kernel>: 'static {
    /// Rows of values for each group that [`Preparation::prepare`] computes.
    const ROWS: usize;

    /// Computes, for the triangles in lanes `at .. at + LANES` of a group, whatever is the same for all
    /// rays with this in common.
    fn prepare<S: Simd>(s: S, common: &Common, group: &[Row], at: usize, rows: &mut [Row]);

    /// [`Kernel::rays`] for rays with this in common, with the rows prepared for the group: the same
    /// operations on the same operands, those that don't depend on the ray done before.
    fn rays_prepared<S: Simd>(
        s: S,
        rays: &K::Many<S>,
        common: &Common,
        group: &[Row],
        rows: &[Row],
        lane: usize,
        t_max: S::F,
    ) -> Lanes<S>;
}

/// Nothing is computed beforehand.
#[derive(Clone, Copy, Debug)]
pub struct Unprepared;

impl<K: Kernel> Preparation<K> for Unprepared {
    const ROWS: usize = 0;

    #[inline(always)]
    fn prepare<S: Simd>(_: S, _: &Common, _: &[Row], _: usize, _: &mut [Row]) {}

    #[inline(always)]
    fn rays_prepared<S: Simd>(
        s: S,
        rays: &K::Many<S>,
        _: &Common,
        group: &[Row],
        _: &[Row],
        lane: usize,
        t_max: S::F,
    ) -> Lanes<S> {
        K::rays(s, rays, group, lane, t_max)
    }
}
