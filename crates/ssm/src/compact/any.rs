//! Whether rays hit anything.

use super::Built;
use super::alone::walk;
use super::beam::{Beam, VisitBeam};
use super::chunk::Chunk;
use super::objects::{Objects, Tested};
use super::segment::SegmentRows;
use accel::{Count, Nearest, Ray};
use lanes::{Blocks, PackedObjects, ROW, Simd};

/// Groups that a beam remembers: more than a ray, for it meets more.
const TOGETHER: usize = 64;

/// Rays of a chunk that are found too far from the others before the rest is taken to be so too.
const TRIES: u32 = 3;

/// Rays on their way through the cells as one.
struct Together<'a, 'o, S, B: Blocks, C> {
    objects: &'a mut Objects<'o, S, B, C, true, true>,
    segments: &'a SegmentRows,
    rays: &'a mut [Tested<B::One>; ROW],
    /// The lanes of those that go on.
    lanes: u32,
    /// The groups looked at lately.
    met: [u32; TOGETHER],
}

impl<S: Simd, B: Blocks, C: Count> VisitBeam for Together<'_, '_, S, B, C> {
    #[inline(always)]
    fn cell(&mut self, number: usize) -> bool {
        self.objects.count.cells(1);
        for &group in self.objects.cells.list(number) {
            self.objects.count.candidates(1);
            let place = &mut self.met[group as usize % TOGETHER];
            if std::mem::replace(place, group) == group {
                continue;
            }
            let mut met =
                self.segments.meets(self.objects.simd, &self.objects.boxes[group as usize]) & self.lanes;
            while met != 0 {
                let lane = met.trailing_zeros() as usize % ROW;
                met &= met - 1;
                self.objects.test(&mut self.rays[lane], group);
                if self.rays[lane].best.object != Nearest::NONE {
                    self.lanes &= !(1 << lane);
                }
            }
        }
        self.lanes != 0
    }

    #[inline(always)]
    fn brick(&self, number: usize) -> u32 {
        self.objects.brick(number)
    }
}

/// Whether each ray hits anything: neighbours together, others by themselves.
#[inline(always)]
pub(super) fn any<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, true, BOXED>,
    rays: &[Ray],
    found: &mut [Nearest],
) {
    let Some(first) = rays.first() else { return };
    let mut chunk = Chunk::new(built.blocks.one(first));
    for (rays, found) in rays.chunks(ROW).zip(found.chunks_mut(ROW)) {
        chunk.fill(built, objects, rays);
        let mut alone = chunk.waiting;
        if BOXED {
            alone = together(built, objects, &mut chunk);
        }
        while alone != 0 {
            let lane = alone.trailing_zeros() as usize % ROW;
            alone &= alone - 1;
            if let Some(segment) = chunk.segments.lane(lane) {
                walk(built, objects, &mut chunk.rays[lane], segment);
            }
        }
        for (found, tested) in found.iter_mut().zip(&mut chunk.rays) {
            built.blocks.resolve(&tested.ray, &mut tested.best);
            *found = tested.best;
        }
    }
}

/// Takes neighbours through the cells as one; returns the rays that are left.
#[inline(always)]
fn together<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, true, BOXED>,
    chunk: &mut Chunk<<O::Blocks as Blocks>::One>,
) -> u32 {
    let Objects { simd, cells, boxes, blocks, count } = objects;
    let mut objects = Objects { simd: *simd, cells, boxes, blocks: *blocks, count: &mut **count };
    let (mut waiting, mut alone) = (chunk.waiting, 0u32);
    while waiting != 0 && alone.count_ones() < TRIES {
        let Some(beam) = Beam::of(*simd, &built.bricks, &chunk.segments, waiting) else {
            // The first is too far from the others.
            alone |= waiting & waiting.wrapping_neg();
            waiting &= waiting - 1;
            continue;
        };
        waiting &= !beam.lanes;
        let (segments, rays) = (&chunk.segments, &mut chunk.rays);
        let met = [u32::MAX; TOGETHER];
        beam.walk(
            &built.bricks,
            &mut Together { objects: &mut objects, segments, rays, lanes: beam.lanes, met },
        );
    }
    alone | waiting
}
