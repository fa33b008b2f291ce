//! Rays made ready together.

use super::Built;
use super::objects::{Objects, Tested};
use super::segment::SegmentRows;
use accel::{Count, Nearest, Ray};
use lanes::{Blocks, PackedObjects, ROW, Simd};

/// Up to 16 rays, made ready.
pub(super) struct Chunk<R> {
    pub segments: SegmentRows,
    pub rays: [Tested<R>; ROW],
    /// Those that are to go through the cells.
    pub waiting: u32,
}

impl<R: Copy> Chunk<R> {
    /// Clips the rays and tests them with what is in no cell.
    #[inline(always)]
    pub fn fill<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
        &mut self,
        built: &Built<O>,
        objects: &mut Objects<'_, S, O::Blocks, C, false, BOXED>,
        rays: &[Ray],
    ) where
        O::Blocks: Blocks<One = R>,
    {
        self.segments = built.bricks.clip_all(objects.simd, rays);
        for (own, ray) in self.rays.iter_mut().zip(rays) {
            let mut tested = Tested::new(&built.blocks, ray);
            if built.apart {
                objects.test(&mut tested, 0);
            }
            *own = tested;
        }
        self.waiting = self.segments.meeting(u32::MAX >> (32 - rays.len()));
    }

    /// Nothing; `first` stands in for rays.
    #[inline(always)]
    pub fn new(first: R) -> Self {
        let nothing = Tested { ray: first, best: Nearest::new(0.0) };
        Self { segments: SegmentRows::NONE, rays: [nothing; ROW], waiting: 0 }
    }
}
