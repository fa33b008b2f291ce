//! Brute force: every object tested for every ray.

use accel::parallel::for_each_chunk;
use accel::{Accel, BuildError, Builder, Footprint, Hit, Nearest, Ray, RaySet, Scene, Workload};
use lanes::{BLOCK, Blocks, Level, PackedObjects, Simd, Task};
use primitives::{KernelId, WithObjects};

/// Builds the reference: no structure at all, every object tested for every ray.
#[derive(Clone, Copy, Debug)]
pub struct Brute {
    /// The ray-triangle test.
    pub kernel: KernelId,
    /// The instruction set.
    pub simd: Level,
}

impl Brute {
    /// Brute force by `kernel` on the best instruction set.
    pub fn new(kernel: KernelId) -> Self {
        Self { kernel, simd: Level::best() }
    }
}

impl Builder for Brute {
    fn id(&self) -> &str {
        "brute"
    }

    fn settings(&self) -> String {
        format!("kernel={} simd={}", self.kernel, self.simd.id())
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        struct Build(Level);
        impl<'s> WithObjects<'s> for Build {
            type Out = Result<Box<dyn Accel + 's>, BuildError>;
            fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
                let mut order = accel::reserved("brute", objects.len())?;
                order.extend(0..objects.len() as u32);
                Ok(Box::new(Built {
                    blocks: objects.blocks("brute", &order)?,
                    objects: objects.len(),
                    simd: self.0,
                    all: objects,
                }))
            }
        }
        primitives::with_objects(scene, self.kernel, Build(self.simd))
    }
}

struct Built<O: PackedObjects> {
    blocks: O::Blocks,
    objects: usize,
    simd: Level,
    all: O,
}

/// Rays that pass over the blocks together, so that each block is fetched once for all of them.
const TOGETHER: usize = 128;

struct Trace<'a, B> {
    blocks: &'a B,
    objects: usize,
    rays: &'a [Ray],
}

impl<B: Blocks> Task for Trace<'_, B> {
    type Out = Vec<Nearest>;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Vec<Nearest> {
        let mut state: Vec<_> =
            self.rays.iter().map(|ray| (self.blocks.one(ray), Nearest::new(ray.t_max))).collect();
        for block in 0..self.objects.div_ceil(BLOCK) {
            let mask = u64::MAX >> (BLOCK - (self.objects - block * BLOCK).min(BLOCK));
            for (ray, best) in &mut state {
                self.blocks.closest(s, block, mask, ray, best);
            }
        }
        for (ray, best) in &mut state {
            self.blocks.resolve(ray, best);
        }
        state.into_iter().map(|(_, best)| best).collect()
    }
}

impl<O: PackedObjects> Built<O> {
    fn nearest(&self, rays: &[Ray]) -> Vec<Nearest> {
        self.simd.run(Trace { blocks: &self.blocks, objects: self.objects, rays })
    }
}

impl<O: PackedObjects> Accel for Built<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.nearest(std::slice::from_ref(ray))[0].hit()
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        assert_eq!(rays.len(), hits.len(), "one place for each ray");
        for_each_chunk(hits, TOGETHER, &|chunk, hits| {
            let first = chunk * TOGETHER;
            let rays: Vec<Ray> = (first..first + hits.len()).map(|i| rays.ray(i)).collect();
            for (hit, nearest) in hits.iter_mut().zip(self.nearest(&rays)) {
                *hit = nearest.hit();
            }
        });
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        let mut hits = vec![None; rays.len()];
        self.trace(rays, &mut hits);
        for (occluded, hit) in occluded.iter_mut().zip(hits) {
            *occluded = hit.is_some();
        }
    }

    fn candidates(&self, _: &Ray, found: &mut Vec<u32>) -> bool {
        found.extend(0..self.objects as u32);
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of_candidates(&self.all, ray, 0..self.objects as u32)
    }

    fn footprint(&self) -> Footprint {
        Footprint::default().geometry_copy("blocks", self.blocks.bytes())
    }
}
