//! All that a ray may meet, however far away.

use super::bricks::Visit;
use super::order::GROUP;
use super::{Built, Cells};
use crate::once::keep_once;
use accel::Ray;
use lanes::{Blocks, EMPTY_SLOT, PackedObjects};

/// Gathers the groups of all cells on a segment.
struct Gather<'a> {
    cells: &'a Cells,
    groups: &'a mut Vec<u32>,
}

impl Visit for Gather<'_> {
    #[inline(always)]
    fn cell(&mut self, number: usize) -> f32 {
        self.groups.extend_from_slice(self.cells.list(number));
        f32::INFINITY
    }

    #[inline(always)]
    fn brick(&self, number: usize) -> u32 {
        self.cells.brick(number)
    }

    #[inline(always)]
    fn step(&mut self) {}
}

impl<O: PackedObjects> Built<O> {
    /// Appends the objects of every group that the ray meets.
    pub(super) fn gather(&self, ray: &Ray, found: &mut Vec<u32>) {
        let mut groups = Vec::new();
        if self.apart {
            groups.push(0);
        }
        if let Some(segment) = self.bricks.clip(ray).lane(0) {
            self.bricks.walk(&segment, 1.0, &mut Gather { cells: &self.cells, groups: &mut groups });
        }
        keep_once(&mut groups, 0);
        let slots = groups.iter().flat_map(|group| *group as usize * GROUP..(*group as usize + 1) * GROUP);
        found.extend(slots.map(|slot| self.blocks.object(slot)).filter(|object| *object != EMPTY_SLOT));
    }
}
