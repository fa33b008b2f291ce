//! A ray that goes through the cells by itself.

use super::Built;
use super::bricks::Visit;
use super::objects::{Objects, Tested};
use super::segment::ClippedSegment;
use accel::{Count, Nearest};
use lanes::{Blocks, PackedObjects, Simd};

/// The groups that have been met lately: a place for each of `N` groups in a row, which
/// neighbours in space mostly are.
#[derive(Clone, Copy)]
pub(super) struct Mailbox<const N: usize>([u32; N]);

impl<const N: usize> Mailbox<N> {
    /// None yet.
    pub const EMPTY: Self = Self([u32::MAX; N]);

    /// Whether it is one of them, which it is from now on.
    #[inline(always)]
    pub fn contains_or_insert(&mut self, group: u32) -> bool {
        let place = &mut self.0[group as usize % N];
        std::mem::replace(place, group) == group
    }
}

/// What a ray that walks by itself knows besides.
#[derive(Clone, Copy)]
pub(super) struct Walking {
    pub segment: ClippedSegment,
    /// Up to where boxes are looked at.
    pub limit: f32,
    pub met: Mailbox<16>,
}

impl Walking {
    /// Not begun.
    pub const NOWHERE: Self =
        Self { segment: ClippedSegment::NOWHERE, limit: ClippedSegment::LIMIT, met: Mailbox::EMPTY };

    /// At the beginning of a segment, with a hit at `t` at most.
    #[inline(always)]
    pub fn new(segment: ClippedSegment, t: f32) -> Self {
        let mut walking = Self { segment, ..Self::NOWHERE };
        walking.found(t);
        walking
    }

    /// Looks no farther than a hit at `t`.
    #[inline(always)]
    pub fn found(&mut self, t: f32) {
        self.limit = self.limit.min(self.segment.limit(t));
    }
}

/// A ray on its way through the cells.
struct Alone<'a, 'o, S, B: Blocks, C, const ANY: bool, const BOXED: bool> {
    objects: &'a mut Objects<'o, S, B, C, ANY, BOXED>,
    ray: &'a mut Tested<B::One>,
    walking: &'a mut Walking,
}

impl<S: Simd, B: Blocks, C: Count, const ANY: bool, const BOXED: bool> Visit
    for Alone<'_, '_, S, B, C, ANY, BOXED>
{
    #[inline(always)]
    fn cell(&mut self, number: usize) -> f32 {
        self.objects.look(self.ray, self.walking, number)
    }

    #[inline(always)]
    fn brick(&self, number: usize) -> u32 {
        self.objects.cells.brick(number)
    }

    #[inline(always)]
    fn step(&mut self) {
        self.objects.count.cells(1);
    }
}

impl<S: Simd, B: Blocks, C: Count, const ANY: bool, const BOXED: bool> Objects<'_, S, B, C, ANY, BOXED> {
    /// Tests what a cell holds; returns as [`Visit::cell`].
    #[inline(always)]
    fn look(&mut self, ray: &mut Tested<B::One>, walking: &mut Walking, cell: usize) -> f32 {
        let before = ray.best.t;
        for &group in self.cells.list(cell) {
            self.count.candidates(1);
            let known = walking.met.contains_or_insert(group);
            let missed = BOXED && !walking.segment.meets(&self.boxes[group as usize], walking.limit);
            // Both, for one jump is mispredicted less often than two.
            if known | missed {
                continue;
            }
            self.test(ray, group);
            if ANY && ray.best.object != Nearest::NONE {
                return f32::NEG_INFINITY;
            }
        }
        if ray.best.t < before {
            walking.found(ray.best.t);
        }
        walking.limit
    }
}

/// Takes a ray through the cells by itself.
#[inline(always)]
pub(super) fn walk<O: PackedObjects, S: Simd, C: Count, const ANY: bool, const BOXED: bool>(
    built: &Built<O>,
    objects: &mut Objects<'_, S, O::Blocks, C, ANY, BOXED>,
    ray: &mut Tested<<O::Blocks as Blocks>::One>,
    segment: ClippedSegment,
) {
    let mut walking = Walking::new(segment, ray.best.t);
    let limit = walking.limit.min(1.0);
    built.bricks.walk(&segment, limit, &mut Alone { objects, ray, walking: &mut walking });
}
