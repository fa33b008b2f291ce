//! How packed triangles are kept in memory.

use super::Kernel;
use accel::{Aabb, Corners, Vec3};
use lanes::{Row, Simd};
use std::fmt::Debug;

/// Keeps the packed triangles of a mesh, and says where its corners lie.
pub trait Storage: Copy + Debug + Send + Sync + 'static {
    /// What a group of 16 triangles consists of.
    type Unit: Copy + Debug + Send + Sync + 'static;
    /// One that holds no triangles.
    const EMPTY: Self::Unit;
    /// Rows that have to be unpacked before a group is tested.
    const UNPACKED_ROWS: usize;

    /// How many units a group has.
    fn units<K: Kernel>() -> usize;

    /// For a mesh with these bounds, which may be empty.
    fn over(bounds: &Aabb) -> Self;

    /// Where a corner is taken to be; keeps the order of coordinates.
    fn place(&self, corner: Vec3) -> Vec3;

    /// Writes a triangle to lane `lane` of a group, which kernels are to see times `scale`.
    fn pack<K: Kernel>(&self, corners: &Corners, scale: f32, group: &mut [Self::Unit], lane: usize);

    /// The rows of a group, unless they have to be unpacked.
    fn kept(group: &[Self::Unit]) -> Option<&[Row]>;

    /// The rows of a group, in which those of `LANES` triangles from lane `at` on are unpacked; `scratch` has room for
    /// [`Storage::UNPACKED_ROWS`].
    fn rows<'a, S: Simd>(
        &self,
        s: S,
        group: &'a [Self::Unit],
        at: usize,
        scale: f32,
        scratch: &'a mut [Row],
    ) -> &'a [Row];
}

/// The rows that the kernel packs.
#[derive(Clone, Copy, Debug)]
pub struct Floats;

impl Storage for Floats {
    type Unit = Row;
    const EMPTY: Row = Row([f32::NAN; lanes::ROW]);
    const UNPACKED_ROWS: usize = 0;

    #[inline(always)]
    fn units<K: Kernel>() -> usize {
        K::ROWS
    }

    fn over(_: &Aabb) -> Self {
        Self
    }

    #[inline(always)]
    fn place(&self, corner: Vec3) -> Vec3 {
        corner
    }

    #[inline(always)]
    fn pack<K: Kernel>(&self, corners: &Corners, scale: f32, group: &mut [Row], lane: usize) {
        K::pack(&corners.map(|corner| corner * scale), group, lane);
    }

    #[inline(always)]
    fn kept(group: &[Row]) -> Option<&[Row]> {
        Some(group)
    }

    #[inline(always)]
    fn rows<'a, S: Simd>(&self, _: S, group: &'a [Row], _: usize, _: f32, _: &'a mut [Row]) -> &'a [Row] {
        group
    }
}
