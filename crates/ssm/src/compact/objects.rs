//! Rays and the groups of objects that they are tested with.

use super::order::GROUP;
use super::segment::UnitBox;
use super::{Built, Cells};
use accel::{Count, Nearest, Ray};
use lanes::{BLOCK, Blocks, PackedObjects, Simd};

/// A ray as objects test it, and its nearest hit.
#[derive(Clone, Copy)]
pub(super) struct Tested<R> {
    pub ray: R,
    pub best: Nearest,
}

impl<R> Tested<R> {
    /// Not tested yet.
    #[inline(always)]
    pub fn new<B: Blocks<One = R>>(blocks: &B, ray: &Ray) -> Self {
        Self { ray: blocks.one(ray), best: Nearest::new(ray.t_max) }
    }

    /// What it has hit, once nothing is left to be tested.
    #[inline(always)]
    pub fn resolved<B: Blocks<One = R>>(&mut self, blocks: &B) -> Nearest {
        blocks.resolve(&self.ray, &mut self.best);
        self.best
    }
}

/// Where rays look for objects.
pub(super) struct Objects<'a, S, B, C, const ANY: bool, const BOXED: bool> {
    pub simd: S,
    pub cells: &'a Cells,
    pub boxes: &'a [UnitBox],
    pub blocks: &'a B,
    pub count: &'a mut C,
}

impl<'a, S: Simd, B: Blocks, C: Count, const ANY: bool, const BOXED: bool> Objects<'a, S, B, C, ANY, BOXED> {
    /// All that the structure holds.
    #[inline(always)]
    pub fn of<O: PackedObjects<Blocks = B>>(simd: S, built: &'a Built<O>, count: &'a mut C) -> Self {
        let Built { cells, boxes, blocks, .. } = built;
        Self { simd, cells, boxes, blocks, count }
    }

    /// Tests the objects of a group.
    #[inline(always)]
    pub fn test(&mut self, ray: &mut Tested<B::One>, group: u32) {
        self.count.blocks(1);
        self.count.tests(GROUP as u64);
        let first = group as usize * GROUP;
        let mask = (u64::MAX >> (BLOCK - GROUP)) << (first % BLOCK);
        if !ANY {
            self.blocks.closest(self.simd, first / BLOCK, mask, &ray.ray, &mut ray.best);
        } else if self.blocks.any(self.simd, first / BLOCK, mask, &ray.ray, ray.best.t) {
            ray.best.object = 0;
        }
    }
}
