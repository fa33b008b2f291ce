//! The maps of a raster behind [`Accel`].

use super::RasterMaps;
use accel::{Accel, Counters, Footprint, Hit, Raster, Ray, RaySet, for_each_ray, image_space};
use lanes::PackedObjects;

impl<O: PackedObjects> RasterMaps<O> {
    /// The pixel of a ray that has to be one of the raster's.
    fn asked_for(&self, ray: &Ray) -> (u32, u32) {
        let Some(pixel) = image_space::pixel_of(self.raster(), ray) else {
            panic!("{ray:?} is no ray of the raster that was asked for");
        };
        pixel
    }
}

impl<O: PackedObjects> Accel for RasterMaps<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let (row, col) = self.asked_for(ray);
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

    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        let (row, col) = self.asked_for(ray);
        self.gather(row, col, found);
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of(self, &self.objects, ray)
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
