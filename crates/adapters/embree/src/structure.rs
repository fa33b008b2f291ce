//! Embree as structures of the comparison.

use accel::{
    Accel, BuildError, Builder, Footprint, Geometry, Hit, Raster, Ray, RaySet, Scene, Workload, for_each_ray,
};
use rayon::prelude::*;

use crate::denormals::{Denormals, DenormalsGuard};
use crate::device::{Device, EmbreeError, Isa};
use crate::packet::WIDTH;
use crate::scene::{Coherence, EmbreeScene, Quality, SceneSettings};
use crate::solids::SolidKinds;

/// Which of Embree's structures and queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Single rays on a plain scene.
    Plain,
    /// Single rays on a robust scene.
    Robust,
    /// Single rays on a compact scene.
    Compact,
    /// Packets of 16 rays on a plain scene: 4 × 4 pixels of a raster, or 16 rays of a list as they come.
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

/// Which packets are said to be coherent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PacketFlag {
    /// Those of rasters.
    #[default]
    Rasters,
    /// All.
    On,
    /// None.
    Off,
}

impl PacketFlag {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Rasters, Self::On, Self::Off];

    /// Its name as a setting.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Rasters => "rasters",
            Self::On => "on",
            Self::Off => "off",
        }
    }

    /// The one of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|flag| flag.id() == id)
    }

    fn of(self, rays: &RaySet) -> Coherence {
        match (self, rays) {
            (Self::On, _) | (Self::Rasters, RaySet::Raster(_)) => Coherence::Coherent,
            (Self::Off, _) | (Self::Rasters, RaySet::List(_)) => Coherence::Incoherent,
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
    /// The widest instructions it may use; none for the processor's best.
    pub isa: Option<Isa>,
    /// Which packets are said to be coherent; packets only.
    pub coherent: PacketFlag,
    /// How solids are given to Embree.
    pub solids: SolidKinds,
}

impl EmbreeBuilder {
    /// With Embree's defaults.
    pub const fn new(variant: Variant) -> Self {
        Self {
            variant,
            quality: Quality::Medium,
            denormals: Denormals::Keep,
            isa: None,
            coherent: PacketFlag::Rasters,
            solids: SolidKinds::User,
        }
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
        let mut text = format!("quality={} denormals={}", self.quality.id(), self.denormals.id());
        if let Some(isa) = self.isa {
            text += &format!(" isa={}", isa.id());
        }
        if self.variant == Variant::Packet {
            text += &format!(" coherent={}", self.coherent.id());
        }
        if self.solids != SolidKinds::User {
            text += &format!(" solids={}", self.solids.id());
        }
        text
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        if let Geometry::Boxes(_) = &scene.geometry {
            return Err(self.unsupported("boxes: Embree has triangles"));
        }
        if matches!(scene.geometry, Geometry::Solids(_)) && self.denormals != Denormals::Keep {
            return Err(self.unsupported("solids without denormal numbers: their tests are not Embree's"));
        }
        let settings = SceneSettings {
            quality: self.quality,
            robust: self.variant == Variant::Robust,
            compact: self.variant == Variant::Compact,
        };
        let threads = rayon::current_num_threads();
        let device = self.isa.map_or_else(|| Device::new(threads), |isa| Device::limited(threads, isa));
        let make = |device| match &scene.geometry {
            Geometry::Triangles(mesh) => EmbreeScene::new(device, mesh, settings),
            Geometry::Solids(solids) => EmbreeScene::of_solids(device, solids, self.solids, settings),
            Geometry::Boxes(_) => EmbreeScene::of_solids(device, &[], self.solids, settings),
        };
        let scene = device.and_then(make).map_err(|error: EmbreeError| BuildError::Library {
            structure: self.variant.id().to_owned(),
            message: error.to_string(),
        })?;
        let packets = (self.variant == Variant::Packet).then_some(self.coherent);
        Ok(Box::new(Built { scene, packets, denormals: self.denormals }))
    }
}

struct Built<'s> {
    scene: EmbreeScene<'s>,
    /// Whether rays go in packets, and which of these are coherent.
    packets: Option<PacketFlag>,
    denormals: Denormals,
}

/// Rows and columns of the tile of pixels that makes a packet.
const TILE: usize = 4;

/// Rays of a list traced by one task of the thread pool; whole packets.
const CHUNK: usize = 4096;

/// Rays made before the denormal mode is set for them, as their arithmetic is Rust's.
const BATCH: usize = 64;

impl Built<'_> {
    /// Traces a set in packets with one of the scene's queries of up to 16 rays.
    fn packets<T: Copy + Default + Send>(
        &self,
        rays: &RaySet,
        out: &mut [T],
        query: impl Fn(&[Ray], &mut [T]) + Sync,
    ) {
        match rays {
            RaySet::Raster(raster) => self.tiles(raster, out, query),
            RaySet::List(rays) => self.runs(rays, out, query),
        }
    }

    /// Traces a list in packets of 16 rays that follow one another; the last may hold fewer.
    fn runs<T: Send>(&self, rays: &[Ray], out: &mut [T], query: impl Fn(&[Ray], &mut [T]) + Sync) {
        let chunk = |(rays, out): (&[Ray], &mut [T])| {
            for (rays, out) in rays.chunks(WIDTH).zip(out.chunks_mut(WIDTH)) {
                self.in_mode(|| query(rays, out));
            }
        };
        if rayon::current_num_threads() == 1 {
            chunk((rays, out));
        } else {
            rays.par_chunks(CHUNK).zip(out.par_chunks_mut(CHUNK)).for_each(chunk);
        }
    }

    /// Traces a raster in packets of 4 × 4 pixels.
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
        match self.packets.map(|flag| flag.of(rays)) {
            Some(coherence) => {
                self.packets(rays, hits, |rays, hits| self.scene.closest16(rays, coherence, hits));
            }
            None => self.singles(rays, hits, |ray| self.scene.closest(ray)),
        }
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "one place for each ray");
        match self.packets.map(|flag| flag.of(rays)) {
            Some(coherence) => {
                let query = |rays: &[Ray], out: &mut [bool]| self.scene.occluded16(rays, coherence, out);
                self.packets(rays, occluded, query);
            }
            None => self.singles(rays, occluded, |ray| self.scene.occluded(ray)),
        }
    }

    fn footprint(&self) -> Footprint {
        let held = usize::try_from(self.scene.memory().now).unwrap_or(usize::MAX);
        let footprint = Footprint::default().structure("memory monitor", held);
        let footprint = match self.scene.solid_bytes() {
            0 => footprint,
            bytes => footprint.structure("numbers of solids", bytes),
        };
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
