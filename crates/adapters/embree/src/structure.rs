//! Embree as structures of the comparison.

use accel::{
    Accel, BuildError, Builder, Footprint, Geometry, Hit, Need, Raster, Ray, RaySet, Scene, for_each_ray,
};
use rayon::prelude::*;

use crate::denormals::{Denormals, DenormalsGuard};
use crate::device::{Device, EmbreeError};
use crate::scene::{EmbreeScene, Quality, SceneSettings};

/// Which of Embree's structures and queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Single rays on a plain scene.
    Plain,
    /// Single rays on a robust scene.
    Robust,
    /// Single rays on a compact scene.
    Compact,
    /// Coherent packets of 16 rays on a plain scene; rasters only.
    Packet,
}

impl Variant {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Plain, Self::Robust, Self::Compact, Self::Packet];

    /// Its id as a structure.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Plain => "embree",
            Self::Robust => "embree-robust",
            Self::Compact => "embree-compact",
            Self::Packet => "embree-packet",
        }
    }
}

/// Builds Embree scenes of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmbreeBuilder {
    /// Structure and queries.
    pub variant: Variant,
    /// Time allowed for the build.
    pub quality: Quality,
    /// Whether queries over sets of rays take denormal numbers as zero.
    pub denormals: Denormals,
}

impl EmbreeBuilder {
    /// With Embree's defaults.
    pub const fn new(variant: Variant) -> Self {
        Self { variant, quality: Quality::Medium, denormals: Denormals::Keep }
    }

    fn unsupported(&self, what: &str) -> BuildError {
        BuildError::Unsupported { structure: self.variant.id().to_owned(), what: what.to_owned() }
    }
}

impl Builder for EmbreeBuilder {
    fn id(&self) -> &str {
        self.variant.id()
    }

    fn settings(&self) -> String {
        format!("quality={} denormals={}", self.quality.id(), self.denormals.id())
    }

    fn build<'s>(&self, scene: &'s Scene, need: &Need) -> Result<Box<dyn Accel + 's>, BuildError> {
        let Geometry::Triangles(mesh) = &scene.geometry else {
            return Err(self.unsupported("boxes: Embree has triangles"));
        };
        if self.variant == Variant::Packet && need.general {
            return Err(self.unsupported("lists of rays: coherent packets are for rasters"));
        }
        let settings = SceneSettings {
            quality: self.quality,
            robust: self.variant == Variant::Robust,
            compact: self.variant == Variant::Compact,
        };
        let scene = Device::new(rayon::current_num_threads())
            .and_then(|device| EmbreeScene::new(device, mesh, settings))
            .map_err(|error: EmbreeError| BuildError::Library {
                structure: self.variant.id().to_owned(),
                message: error.to_string(),
            })?;
        Ok(Box::new(Built { scene, packets: self.variant == Variant::Packet, denormals: self.denormals }))
    }
}

struct Built<'s> {
    scene: EmbreeScene<'s>,
    packets: bool,
    denormals: Denormals,
}

/// Rows and columns of the tile of pixels that makes a packet.
const TILE: usize = 4;

/// Rays made before the denormal mode is set for them, as their arithmetic is Rust's.
const BATCH: usize = 64;

impl Built<'_> {
    /// Traces a raster in packets of 4 × 4 pixels with one of the scene's queries of up to 16 rays.
    fn tiles<T: Copy + Default + Send>(
        &self,
        raster: &Raster,
        out: &mut [T],
        query: impl Fn(&[Ray], &mut [T]) + Sync,
    ) {
        let cols = raster.cols as usize;
        if raster.is_empty() {
            return;
        }
        let band = |(band, out): (usize, &mut [T])| {
            let rows = out.len() / cols;
            for left in (0..cols).step_by(TILE) {
                let width = TILE.min(cols - left);
                let mut rays = [NO_RAY; TILE * TILE];
                let mut found = [T::default(); TILE * TILE];
                for row in 0..rows {
                    for col in 0..width {
                        let (y, x) = ((band * TILE + row) as u32, (left + col) as u32);
                        rays[row * width + col] = raster.ray(y, x);
                    }
                }
                let count = rows * width;
                self.in_mode(|| query(&rays[..count], &mut found[..count]));
                for row in 0..rows {
                    let from = &found[row * width..][..width];
                    out[row * cols + left..][..width].copy_from_slice(from);
                }
            }
        };
        if rayon::current_num_threads() == 1 {
            out.chunks_mut(TILE * cols).enumerate().for_each(band);
        } else {
            out.par_chunks_mut(TILE * cols).enumerate().for_each(band);
        }
    }

    /// Traces rays one by one.
    fn singles<T: Send>(&self, rays: &RaySet, out: &mut [T], query: impl Fn(&Ray) -> T + Sync) {
        if self.denormals == Denormals::Keep {
            return for_each_ray(rays, out, query);
        }
        out.par_chunks_mut(BATCH).enumerate().for_each(|(batch, out)| {
            let mut made = [NO_RAY; BATCH];
            for (i, ray) in made[..out.len()].iter_mut().enumerate() {
                *ray = rays.ray(batch * BATCH + i);
            }
            self.in_mode(|| {
                for (out, ray) in out.iter_mut().zip(&made) {
                    *out = query(ray);
                }
            });
        });
    }

    #[inline]
    fn in_mode(&self, queries: impl FnOnce()) {
        if self.denormals == Denormals::Keep {
            return queries();
        }
        // SAFETY: the queries copy rays and hits and call Embree; they compute nothing themselves.
        let guard = unsafe { DenormalsGuard::set(self.denormals) };
        queries();
        drop(guard);
    }
}

const NO_RAY: Ray = Ray::new(accel::Vec3::ZERO, accel::Vec3::Z);

impl Accel for Built<'_> {
    #[inline]
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.scene.closest(ray)
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.scene.occluded(ray)
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        assert_eq!(rays.len(), hits.len(), "one place for each ray");
        match rays {
            RaySet::Raster(raster) if self.packets => {
                self.tiles(raster, hits, |rays, hits| self.scene.closest16(rays, hits));
            }
            _ => self.singles(rays, hits, |ray| self.scene.closest(ray)),
        }
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one place for each ray");
        match rays {
            RaySet::Raster(raster) if self.packets => {
                self.tiles(raster, occluded, |rays, occluded| self.scene.occluded16(rays, occluded));
            }
            _ => self.singles(rays, occluded, |ray| self.scene.occluded(ray)),
        }
    }

    fn footprint(&self) -> Footprint {
        let held = usize::try_from(self.scene.memory().now).unwrap_or(usize::MAX);
        let footprint = Footprint::default().structure("memory monitor", held);
        match self.scene.copied_bytes() {
            0 => footprint,
            bytes => footprint.geometry_copy("padded positions", bytes),
        }
    }

    fn plan(&self) -> String {
        let (major, minor, patch) = self.scene.version();
        let peak = self.scene.memory().peak;
        format!("Embree {major}.{minor}.{patch}; held at most {peak} bytes while building")
    }
}

#[cfg(test)]
mod tests;
