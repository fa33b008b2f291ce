//! Tracing: one ray, or batches on all threads of the current pool.

use super::bricks::Visit;
use super::order::GROUP;
use super::segment::{ClippedSegment, UnitBox};
use super::{Built, Cells, sort};
use accel::parallel::for_each_chunk;
use accel::{Count, Counters, Nearest, NoCount, Ray, RaySet};
use lanes::packet::rows;
use lanes::{BLOCK, Blocks, PackedObjects, Portable, ROW, Simd, Task};

/// Rays for which the instruction set is chosen once.
const BATCH: usize = 512;

/// Rays that are put in order together.
const SORTED: usize = 1 << 16;

/// The groups that a ray has met lately: a place for each of a number of groups in a row, which
/// neighbours in space mostly are.
struct Mailbox([u32; 16]);

impl Mailbox {
    #[inline(always)]
    fn contains_or_insert(&mut self, group: u32) -> bool {
        let place = &mut self.0[group as usize % 16];
        std::mem::replace(place, group) == group
    }
}

/// A ray on its way through the cells.
struct TraversalState<'a, S, B: Blocks, C, const ANY: bool, const BOXED: bool> {
    simd: S,
    cells: &'a Cells,
    boxes: &'a [UnitBox],
    blocks: &'a B,
    ray: B::One,
    segment: ClippedSegment,
    /// Up to where boxes are looked at.
    limit: f32,
    met: Mailbox,
    best: Nearest,
    count: &'a mut C,
}

impl<S: Simd, B: Blocks, C: Count, const ANY: bool, const BOXED: bool>
    TraversalState<'_, S, B, C, ANY, BOXED>
{
    /// Tests the objects of a group.
    #[inline(always)]
    fn test(&mut self, group: u32) {
        self.count.blocks(1);
        self.count.tests(GROUP as u64);
        let first = group as usize * GROUP;
        let mask = (u64::MAX >> (BLOCK - GROUP)) << (first % BLOCK);
        if !ANY {
            self.blocks.closest(self.simd, first / BLOCK, mask, &self.ray, &mut self.best);
        } else if self.blocks.any(self.simd, first / BLOCK, mask, &self.ray, self.best.t) {
            self.best.object = 0;
        }
    }
}

impl<S: Simd, B: Blocks, C: Count, const ANY: bool, const BOXED: bool> Visit
    for TraversalState<'_, S, B, C, ANY, BOXED>
{
    #[inline(always)]
    fn cell(&mut self, number: usize) -> f32 {
        let before = self.best.t;
        for &group in self.cells.list(number) {
            self.count.candidates(1);
            let known = self.met.contains_or_insert(group);
            let missed = BOXED && !self.segment.meets(&self.boxes[group as usize], self.limit);
            // Both, for one jump is mispredicted less often than two.
            if known | missed {
                continue;
            }
            self.test(group);
            if ANY && self.best.object != Nearest::NONE {
                return f32::NEG_INFINITY;
            }
        }
        if self.best.t < before {
            self.limit = self.limit.min(self.segment.limit(self.best.t));
        }
        self.limit
    }

    #[inline(always)]
    fn brick(&self, number: usize) -> u32 {
        self.cells.references[self.cells.positions[number] as usize]
    }

    #[inline(always)]
    fn step(&mut self) {
        self.count.cells(1);
    }
}

/// Rays traced with one instruction set, for the nearest hit or any.
struct Batch<'a, O: PackedObjects, C, const ANY: bool> {
    built: &'a Built<O>,
    rays: &'a [Ray],
    found: &'a mut [Nearest],
    count: &'a mut C,
}

impl<O: PackedObjects, C: Count, const ANY: bool> Task for Batch<'_, O, C, ANY> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        if self.built.boxes.is_empty() {
            self.trace::<S, false>(simd);
        } else {
            self.trace::<S, true>(simd);
        }
    }
}

impl<O: PackedObjects, C: Count, const ANY: bool> Batch<'_, O, C, ANY> {
    /// With the boxes of groups or without.
    #[inline(always)]
    fn trace<S: Simd, const BOXED: bool>(self, simd: S) {
        let Self { built, rays, found, count } = self;
        let Built { bricks, cells, boxes, blocks, .. } = built;
        for (rays, found) in rays.chunks(ROW).zip(found.chunks_mut(ROW)) {
            let segments =
                if let [ray] = rays { bricks.clip(ray) } else { bricks.clip_rows(simd, &rows(simd, rays)) };
            for (lane, (ray, found)) in rays.iter().zip(found).enumerate() {
                let mut state = TraversalState::<_, _, _, ANY, BOXED> {
                    simd,
                    cells,
                    boxes,
                    blocks,
                    ray: blocks.one(ray),
                    segment: ClippedSegment::NOWHERE,
                    limit: ClippedSegment::LIMIT,
                    met: Mailbox([u32::MAX; 16]),
                    best: Nearest::new(ray.t_max),
                    count,
                };
                if built.apart {
                    state.test(0);
                }
                if !(ANY && state.best.object != Nearest::NONE)
                    && let Some(segment) = segments.lane(lane)
                {
                    state.segment = segment;
                    state.limit = state.limit.min(segment.limit(state.best.t));
                    bricks.walk(&segment, state.limit.min(1.0), &mut state);
                }
                blocks.resolve(&state.ray, &mut state.best);
                *found = state.best;
            }
        }
    }
}

impl<O: PackedObjects> Built<O> {
    fn batch<const ANY: bool>(&self, rays: &[Ray], found: &mut [Nearest]) {
        self.settings.simd.run(Batch::<_, _, ANY> { built: self, rays, found, count: &mut NoCount });
    }

    /// One ray.
    pub(super) fn nearest<const ANY: bool>(&self, ray: &Ray) -> Nearest {
        let mut found = [Nearest::new(ray.t_max)];
        self.batch::<ANY>(std::slice::from_ref(ray), &mut found);
        found[0]
    }

    /// All rays of a set.
    pub(super) fn batches<const ANY: bool, T: Send>(
        &self,
        rays: &RaySet,
        out: &mut [T],
        of: impl Fn(&Nearest) -> T + Sync,
    ) {
        assert_eq!(rays.len(), out.len(), "one place for each ray");
        match rays {
            RaySet::List(list) if self.sort && list.len() >= BATCH => {
                for_each_chunk(out, SORTED, &|chunk, out| {
                    let rays = &list[chunk * SORTED..][..out.len()];
                    self.in_order::<ANY, _>(rays, out, &of);
                });
            }
            _ => for_each_chunk(out, BATCH, &|batch, out| {
                let mut made = Vec::new();
                let own = slice(rays, batch * BATCH, out.len(), &mut made);
                let mut found = [Nearest::new(0.0); BATCH];
                self.batch::<ANY>(own, &mut found[..out.len()]);
                for (out, nearest) in out.iter_mut().zip(&found) {
                    *out = of(nearest);
                }
            }),
        }
    }

    /// Rays in an order that suits the caches; what they find goes where they stood.
    fn in_order<const ANY: bool, T>(&self, rays: &[Ray], out: &mut [T], of: &impl Fn(&Nearest) -> T) {
        let order = sort::coherent(self.settings.simd, rays, self.grid.bounds());
        let mut own = Vec::with_capacity(BATCH);
        let mut found = [Nearest::new(0.0); BATCH];
        for numbers in order.chunks(BATCH) {
            own.clear();
            own.extend(numbers.iter().map(|number| rays[*number as usize]));
            self.batch::<ANY>(&own, &mut found[..own.len()]);
            for (number, nearest) in numbers.iter().zip(&found) {
                out[*number as usize] = of(nearest);
            }
        }
    }

    /// What tracing a set costs.
    pub(super) fn counted<const ANY: bool>(&self, rays: &RaySet) -> Counters {
        let mut counters = Counters::default();
        let mut made = Vec::new();
        for first in (0..rays.len()).step_by(BATCH) {
            let own = slice(rays, first, BATCH.min(rays.len() - first), &mut made);
            let mut found = [Nearest::new(0.0); BATCH];
            let found = &mut found[..own.len()];
            // The same steps at every level: one is enough.
            Batch::<_, _, ANY> { built: self, rays: own, found, count: &mut counters }.run(Portable);
        }
        counters
    }
}

/// `count` rays of a set from `first` on; those of an image are put into `made`.
fn slice<'a>(rays: &'a RaySet, first: usize, count: usize, made: &'a mut Vec<Ray>) -> &'a [Ray] {
    match rays {
        RaySet::List(list) => &list[first..first + count],
        RaySet::Raster(_) => {
            made.clear();
            made.extend((first..first + count).map(|i| rays.ray(i)));
            made
        }
    }
}
