//! Rays made ready together.

use super::Built;
use super::objects::{Objects, Tested};
use super::segment::SegmentRows;
use accel::{Count, Nearest, Ray};
use lanes::packet::rows;
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
    pub fn fill<O: PackedObjects, S: Simd, C: Count, const ANY: bool, const BOXED: bool>(
        &mut self,
        built: &Built<O>,
        objects: &mut Objects<'_, S, O::Blocks, C, ANY, BOXED>,
        rays: &[Ray],
    ) where
        O::Blocks: Blocks<One = R>,
    {
        let simd = objects.simd;
        self.segments = match rays {
            [ray] => built.bricks.clip(ray),
            _ => built.bricks.clip_rows(simd, &rows(simd, rays)),
        };
        self.waiting = 0;
        for (lane, ray) in rays.iter().enumerate() {
            let mut tested = Tested { ray: built.blocks.one(ray), best: Nearest::new(ray.t_max) };
            if built.apart {
                objects.test(&mut tested, 0);
            }
            self.waiting |= u32::from(!ANY || tested.best.object == Nearest::NONE) << lane;
            self.rays[lane] = tested;
        }
        self.waiting = self.segments.meeting(self.waiting);
    }

    /// Nothing; `first` stands in for rays.
    #[inline(always)]
    pub fn new(first: R) -> Self {
        let nothing = Tested { ray: first, best: Nearest::new(0.0) };
        Self { segments: SegmentRows::NONE, rays: [nothing; ROW], waiting: 0 }
    }
}
