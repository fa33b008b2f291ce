//! Tracing: one ray, or batches on all threads of the current pool.

use super::Built;
use super::order::GROUP;
use accel::objects::{BLOCK, Blocks};
use accel::simd::{Simd, Task};
use accel::{Count, Counters, Nearest, NoCount, Objects, Ray, RaySet};
use rayon::prelude::*;

/// Rays traced by one task of the thread pool.
const CHUNK: usize = 4096;

/// The groups that a ray has met lately: a place for each of a number of groups in a row, which
/// neighbours in space mostly are.
struct Mailbox([u32; 16]);

impl Mailbox {
    #[inline(always)]
    fn new() -> Self {
        Self([u32::MAX; 16])
    }

    #[inline(always)]
    fn contains_or_insert(&mut self, group: u32) -> bool {
        let place = &mut self.0[group as usize % 16];
        std::mem::replace(place, group) == group
    }
}

impl<O: Objects> Built<O> {
    /// The nearest hit, or any hit.
    #[inline(always)]
    fn walk<S: Simd, C: Count, const ANY: bool>(&self, s: S, ray: &Ray, count: &mut C) -> Nearest {
        let mut best = Nearest::new(ray.t_max);
        let Some(segment) = self.grid.clip(ray) else {
            return best;
        };
        let prepared = self.blocks.one(ray);
        let mut met = Mailbox::new();
        let mut cells = 0;
        let visit = |cell: usize| {
            let list = self.cells[cell] as usize..self.cells[cell + 1] as usize;
            let before = best.t;
            for &group in &self.references[list] {
                count.candidates(1);
                if met.contains_or_insert(group) {
                    continue;
                }
                count.blocks(1);
                count.tests(GROUP as u64);
                let first = group as usize * GROUP;
                let mask = (u64::MAX >> (BLOCK - GROUP)) << (first % BLOCK);
                if ANY {
                    if self.blocks.any(s, first / BLOCK, mask, &prepared, best.t) {
                        best.object = 0;
                        return f32::NEG_INFINITY;
                    }
                } else {
                    self.blocks.closest(s, first / BLOCK, mask, &prepared, &mut best);
                }
            }
            if best.t < before { segment.limit(best.t) } else { f32::INFINITY }
        };
        self.layout.walk(&self.occupied, &segment, visit, || cells += 1);
        count.cells(cells);
        best
    }

    /// One ray.
    pub(super) fn nearest<const ANY: bool>(&self, ray: &Ray) -> Nearest {
        self.settings.simd.run(One::<O, ANY>(self, ray))
    }

    /// All rays of a set.
    pub(super) fn batches<const ANY: bool, T: Send>(
        &self,
        rays: &RaySet,
        out: &mut [T],
        of: impl Fn(&Nearest) -> T + Sync,
    ) {
        assert_eq!(rays.len(), out.len(), "one place for each ray");
        out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, out)| {
            let batch = Batch::<O, _, _, ANY> { built: self, rays, first: chunk * CHUNK, out, of: &of };
            self.settings.simd.run(batch);
        });
    }

    /// What tracing a set costs.
    pub(super) fn counted<const ANY: bool>(&self, rays: &RaySet) -> Counters {
        self.settings.simd.run(Counted::<O, ANY>(self, rays))
    }
}

struct One<'a, O: Objects, const ANY: bool>(&'a Built<O>, &'a Ray);

impl<O: Objects, const ANY: bool> Task for One<'_, O, ANY> {
    type Out = Nearest;
    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Nearest {
        self.0.walk::<S, _, ANY>(s, self.1, &mut NoCount)
    }
}

struct Batch<'a, O: Objects, T, F, const ANY: bool> {
    built: &'a Built<O>,
    rays: &'a RaySet,
    first: usize,
    out: &'a mut [T],
    of: &'a F,
}

impl<O: Objects, T, F: Fn(&Nearest) -> T, const ANY: bool> Task for Batch<'_, O, T, F, ANY> {
    type Out = ();
    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        for (i, out) in self.out.iter_mut().enumerate() {
            let ray = self.rays.ray(self.first + i);
            *out = (self.of)(&self.built.walk::<S, _, ANY>(s, &ray, &mut NoCount));
        }
    }
}

struct Counted<'a, O: Objects, const ANY: bool>(&'a Built<O>, &'a RaySet);

impl<O: Objects, const ANY: bool> Task for Counted<'_, O, ANY> {
    type Out = Counters;
    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Counters {
        let mut counters = Counters::default();
        for i in 0..self.1.len() {
            self.0.walk::<S, _, ANY>(s, &self.1.ray(i), &mut counters);
        }
        counters
    }
}
