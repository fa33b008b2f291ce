//! The maps that a plan names, behind [`Accel`].

use super::Plan;
use crate::general::General;
use crate::raster::{Bytes, RasterMaps};
use accel::parallel::for_each_chunk;
use accel::{Accel, BuildError, Cancel, Counters, Footprint, Hit, Ray, RaySet};
use lanes::PackedObjects;

/// What a plan built.
pub(super) struct Built<O: PackedObjects> {
    objects: O,
    plan: Plan,
    raster: Option<RasterMaps<O>>,
    general: Option<General<O>>,
}

/// Rays of a list that one task of the thread pool traces: all in long streams, unless that leaves a thread with nothing.
fn chunk(rays: usize) -> usize {
    const MIN: usize = 1 << 13;
    const MAX: usize = 1 << 18;
    let shares = match accel::parallel::threads() {
        1 => 1,
        threads => 4 * threads,
    };
    rays.div_ceil(shares).next_multiple_of(MIN).clamp(MIN, MAX)
}

impl<O: PackedObjects> Built<O> {
    /// Builds what the plan names.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if it would take more than `limit` or than the system gives, and [`BuildError::Cancelled`].
    pub fn new(objects: O, plan: Plan, limit: u128, cancel: Cancel) -> Result<Self, BuildError> {
        // The image's maps are built first, and are there while the others are built.
        let allowed = Bytes { held: limit.saturating_sub(plan.beside), peak: limit };
        let image = |(raster, settings)| RasterMaps::build(objects, &raster, settings, allowed, cancel);
        let raster = plan.raster.map(image).transpose()?;
        let general = plan.general.map(|settings| General::new(&objects, settings, cancel)).transpose()?;
        Ok(Self { objects, plan, raster, general })
    }

    /// The image maps, where the rays are the image's or there is nothing else.
    fn image(&self, rays: &RaySet) -> Option<&RasterMaps<O>> {
        let maps = self.raster.as_ref()?;
        let same = matches!(rays, RaySet::Raster(raster) if raster == maps.raster());
        (same || self.general.is_none()).then_some(maps)
    }

    fn general(&self) -> &General<O> {
        self.general.as_ref().expect("a workload that names no rays allows none to be traced")
    }

    fn trace_general<T: Send>(&self, rays: &RaySet, out: &mut [T], of: impl Fn(&[Ray], &mut [T]) + Sync) {
        assert_eq!(rays.len(), out.len(), "one place for each ray");
        let size = chunk(rays.len());
        for_each_chunk(out, size, &|chunk, out| {
            let first = chunk * size;
            match rays {
                RaySet::List(list) => of(&list[first..first + out.len()], out),
                RaySet::Raster(_) => of(&rays_of(rays, first, out.len()), out),
            }
        });
    }
}

fn rays_of(rays: &RaySet, first: usize, len: usize) -> Vec<Ray> {
    (first..first + len).map(|i| rays.ray(i)).collect()
}

impl<O: PackedObjects> Accel for Built<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        if let (None, Some(maps)) = (&self.general, &self.raster) {
            return Accel::closest(maps, ray);
        }
        let mut hit = None;
        self.general().closest(std::slice::from_ref(ray), std::slice::from_mut(&mut hit));
        hit
    }

    fn occluded(&self, ray: &Ray) -> bool {
        if let (None, Some(maps)) = (&self.general, &self.raster) {
            return Accel::occluded(maps, ray);
        }
        let mut occluded = false;
        self.general().occluded(std::slice::from_ref(ray), std::slice::from_mut(&mut occluded));
        occluded
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        match self.image(rays) {
            Some(maps) => Accel::trace(maps, rays, hits),
            None => self.trace_general(rays, hits, |rays, hits| self.general().closest(rays, hits)),
        }
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        match self.image(rays) {
            Some(maps) => Accel::trace_occluded(maps, rays, occluded),
            None => self.trace_general(rays, occluded, |rays, out| self.general().occluded(rays, out)),
        }
    }

    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        if let (None, Some(maps)) = (&self.general, &self.raster) {
            return Accel::candidates(maps, ray, found);
        }
        self.general().gather(ray, found);
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of(self, &self.objects, ray)
    }

    fn footprint(&self) -> Footprint {
        let mut footprint = Footprint::default();
        for part in
            [self.raster.as_ref().map(Accel::footprint), self.general.as_ref().map(General::footprint)]
        {
            footprint.parts.extend(part.unwrap_or_default().parts);
        }
        footprint
    }

    fn plan(&self) -> String {
        match &self.raster {
            Some(maps) => format!("{}\n{}", self.plan, Accel::plan(maps)),
            None => self.plan.to_string(),
        }
    }

    fn count(&self, rays: &RaySet, occlusion: bool) -> Option<Counters> {
        match self.image(rays) {
            Some(maps) => Accel::count(maps, rays, occlusion),
            None => Some(self.general().count(&rays_of(rays, 0, rays.len()), occlusion)),
        }
    }
}
