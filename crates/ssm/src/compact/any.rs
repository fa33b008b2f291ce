//! Whether rays hit anything.

use super::Built;
use super::alone::{Mailbox, walk};
use super::beam::{Beam, VisitBeam};
use super::objects::{Objects, Tested};
use super::segment::SegmentRows;
use super::sort;
use accel::{Count, Nearest, Ray};
use lanes::{Blocks, PackedObjects, ROW, Simd, next_lane};

/// Groups that a beam remembers: more than a ray, for it meets more.
const TOGETHER: usize = 64;

/// Rays of a chunk that are found too far from the others before the rest is taken to be so too.
const TRIES: u32 = 3;

/// Of so many pairs of neighbours one is looked at to tell whether rays go the same way.
const PAIRS: usize = 5;

/// The squared cosine of an angle of 6 degrees: rays go as beams where neighbours mostly go closer than that. At 10 degrees, rays
/// that were put in order are often taken for such, too, though their beams cost more than they spare.
const ALIKE: f32 = 0.99;

/// Rays on their way through the cells as one.
struct Together<'a, 'o, S, B: Blocks, C> {
    objects: &'a mut Objects<'o, S, B, C, true, true>,
    segments: &'a SegmentRows,
    rays: &'a mut [Tested<B::One>; ROW],
    /// The lanes of those that go on.
    lanes: u32,
    /// The groups looked at lately.
    met: Mailbox<TOGETHER>,
}

impl<S: Simd, B: Blocks, C: Count> VisitBeam for Together<'_, '_, S, B, C> {
    #[inline(always)]
    fn cell(&mut self, number: usize) -> bool {
        self.objects.count.cells(1);
        for &group in self.objects.cells.list(number) {
            self.objects.count.candidates(1);
            if self.met.contains_or_insert(group) {
                continue;
            }
            let mut met =
                self.segments.meets(self.objects.simd, &self.objects.boxes[group as usize]) & self.lanes;
            while let Some(lane) = next_lane(&mut met) {
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
        self.objects.cells.brick(number)
    }
}

/// Whether each ray hits anything: neighbours together where rays go the same way, others by themselves.
#[inline(always)]
pub(super) fn any<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, true, BOXED>,
    rays: &[Ray],
    found: &mut [Nearest],
) {
    let Built { bricks, blocks, .. } = built;
    let beams = BOXED && rays.len() > 1 && sort::is_coherent(rays, PAIRS, ALIKE);
    for (own, found) in rays.chunks(ROW).zip(found.chunks_mut(ROW)) {
        let mut waiting = apart(built, objects, own, found);
        if waiting == 0 {
            continue;
        }
        let segments = bricks.clip_all(objects.simd, own);
        waiting = segments.meeting(waiting);
        if beams {
            waiting = together(built, objects, own, found, &segments, waiting);
        }
        while let Some(lane) = next_lane(&mut waiting) {
            if let Some(segment) = segments.lane(lane) {
                let mut tested = Tested::new(blocks, &own[lane]);
                walk(built, objects, &mut tested, segment);
                found[lane] = tested.best;
            }
        }
    }
}

/// Tests rays with what is in no cell; returns the lanes of those that hit none of it.
#[inline(always)]
fn apart<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, true, BOXED>,
    rays: &[Ray],
    found: &mut [Nearest],
) -> u32 {
    let mut left = 0;
    for (lane, (ray, found)) in rays.iter().zip(found).enumerate() {
        *found = Nearest::new(ray.t_max);
        if built.apart {
            let mut tested = Tested::new(&built.blocks, ray);
            objects.test(&mut tested, 0);
            *found = tested.best;
        }
        left |= u32::from(found.object == Nearest::NONE) << lane;
    }
    left
}

/// Takes neighbours through the cells as one; returns the rays that are left.
#[inline(always)]
fn together<O: PackedObjects, S: Simd, C: Count, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, true, BOXED>,
    rays: &[Ray],
    found: &mut [Nearest],
    segments: &SegmentRows,
    mut waiting: u32,
) -> u32 {
    let Some(first) = rays.first() else { return 0 };
    let Objects { simd, cells, boxes, blocks, count } = objects;
    let mut objects = Objects { simd: *simd, cells, boxes, blocks: *blocks, count: &mut **count };
    let mut tested = [Tested::new(&built.blocks, first); ROW];
    for (tested, ray) in tested.iter_mut().zip(rays).skip(1) {
        *tested = Tested::new(&built.blocks, ray);
    }
    let mut alone = 0u32;
    while waiting != 0 && alone.count_ones() < TRIES {
        let Some(beam) = Beam::of(*simd, &built.bricks, segments, waiting) else {
            // The first is too far from the others.
            alone |= waiting & waiting.wrapping_neg();
            waiting &= waiting - 1;
            continue;
        };
        waiting &= !beam.lanes;
        let met = Mailbox::EMPTY;
        let rays = &mut tested;
        beam.walk(
            &built.bricks,
            &mut Together { objects: &mut objects, segments, rays, lanes: beam.lanes, met },
        );
    }
    // Rays that met what is apart do not take part.
    for (found, tested) in found.iter_mut().zip(&tested) {
        if tested.best.object != Nearest::NONE {
            *found = tested.best;
        }
    }
    alone | waiting
}
