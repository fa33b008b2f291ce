//! The maps of a raster behind [`Accel`].

use super::RasterMaps;
use accel::{Accel, Counters, Footprint, Hit, Raster, Ray, RaySet, for_each_ray};
use lanes::PackedObjects;

impl<O: PackedObjects> Accel for RasterMaps<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let Some((row, col)) = self.pixel_of(ray) else {
            panic!("{ray:?} is no ray of the raster that was asked for");
        };
        RasterMaps::closest(self, row, col)
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        match rays {
            RaySet::Raster(raster) if raster == self.raster() => RasterMaps::trace(self, hits),
            _ => for_each_ray(rays, hits, |ray| Accel::closest(self, ray)),
        }
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        let mut hits = vec![None; rays.len()];
        Accel::trace(self, rays, &mut hits);
        for (occluded, hit) in occluded.iter_mut().zip(hits) {
            *occluded = hit.is_some();
        }
    }

    fn footprint(&self) -> Footprint {
        RasterMaps::footprint(self)
    }

    fn plan(&self) -> String {
        let Raster { rows, cols, projection, .. } = self.raster();
        format!(
            "{rows} x {cols} {projection:?} image: {} of {} objects can be seen, in {} blocks",
            self.shown(),
            self.objects.len(),
            self.blocks()
        )
    }

    fn count(&self, rays: &RaySet, _: bool) -> Option<Counters> {
        matches!(rays, RaySet::Raster(raster) if raster == self.raster()).then(|| RasterMaps::count(self))
    }
}
