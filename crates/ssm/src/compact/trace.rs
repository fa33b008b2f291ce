//! Tracing: one ray, or batches on all threads of the current pool.

use super::any::any;
use super::nearest::nearest;
use super::objects::Objects;
use super::{Built, sort};
use accel::parallel::for_each_chunk;
use accel::{Count, Counters, Nearest, NoCount, Ray, RaySet};
use lanes::{PackedObjects, Portable, Simd, Task};

/// Rays for which the instruction set is chosen once.
const BATCH: usize = 512;

/// Rays that are put in order together.
const SORTED: usize = 1 << 16;

/// Of so many pairs of neighbours in a list one is looked at.
const SAMPLE: usize = 61;

/// The squared cosine of a quarter of a right angle: a list whose neighbours go closer than that keeps its order.
const ALIKE: f32 = 0.85;

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
        let Self { built, rays, found, count } = self;
        let boxed = !built.boxes.is_empty();
        // By constants one after the other, so that nothing is compiled that they rule out.
        if ANY {
            if boxed {
                any::<_, _, _, true>(built, &mut Objects::of(simd, built, count), rays, found);
            } else {
                any::<_, _, _, false>(built, &mut Objects::of(simd, built, count), rays, found);
            }
        } else if boxed {
            nearest::<_, _, _, true>(built, &mut Objects::of(simd, built, count), rays, found);
        } else {
            nearest::<_, _, _, false>(built, &mut Objects::of(simd, built, count), rays, found);
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
            RaySet::List(list)
                if self.sort[usize::from(ANY)]
                    && list.len() >= BATCH
                    && !sort::is_coherent(list, SAMPLE, ALIKE) =>
            {
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
