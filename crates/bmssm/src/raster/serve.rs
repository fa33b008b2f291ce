//! The maps of a raster behind [`Accel`].

use super::{RasterMaps, Settings};
use accel::{
    Accel, BuildError, Builder, Counters, Footprint, Hit, Need, Objects, Raster, Ray, RaySet, Scene,
    WithObjects, for_each_ray,
};

/// Builds `bmssm` for needs that name a raster and no other rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct RasterBmssm {
    /// How the maps are made.
    pub settings: Settings,
}

impl Builder for RasterBmssm {
    fn id(&self) -> &str {
        "bmssm"
    }

    fn settings(&self) -> String {
        let Settings { kernel, simd, tile, depth_bits, apart } = self.settings;
        format!("kernel={kernel} simd={} tile={tile} depth_bits={depth_bits} apart={apart}", simd.id())
    }

    fn build<'s>(&self, scene: &'s Scene, need: &Need) -> Result<Box<dyn Accel + 's>, BuildError> {
        struct Build<'r>(&'r Raster, Settings);
        impl<'s> WithObjects<'s> for Build<'_> {
            type Out = Box<dyn Accel + 's>;
            fn objects<O: Objects + 's>(self, objects: O) -> Self::Out {
                Box::new(RasterMaps::build(objects, self.0, self.1))
            }
        }
        match need.raster {
            Some(raster) if !need.general => {
                Ok(scene.with_objects(self.settings.kernel, Build(&raster, self.settings)))
            }
            _ => Err(BuildError::Unsupported {
                structure: self.id().into(),
                what: "rays other than one raster's".into(),
            }),
        }
    }
}

impl<O: Objects> Accel for RasterMaps<O> {
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
