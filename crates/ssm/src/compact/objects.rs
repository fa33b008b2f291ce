//! Rays and the groups of objects that they are tested with.

use super::Cells;
use super::order::GROUP;
use super::segment::UnitBox;
use accel::{Count, Nearest};
use lanes::{BLOCK, Blocks, Simd};

/// A ray as objects test it, and its nearest hit.
#[derive(Clone, Copy)]
pub(super) struct Tested<R> {
    pub ray: R,
    pub best: Nearest,
}

/// Where rays look for objects.
pub(super) struct Objects<'a, S, B, C, const ANY: bool, const BOXED: bool> {
    pub simd: S,
    pub cells: &'a Cells,
    pub boxes: &'a [UnitBox],
    pub blocks: &'a B,
    pub count: &'a mut C,
}

impl<S: Simd, B: Blocks, C: Count, const ANY: bool, const BOXED: bool> Objects<'_, S, B, C, ANY, BOXED> {
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

    /// The brick that the divided cell `number` holds.
    #[inline(always)]
    pub fn brick(&self, number: usize) -> u32 {
        self.cells.references[self.cells.positions[number] as usize]
    }
}
