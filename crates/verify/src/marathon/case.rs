//! One case: a scene and rays from a seed, and structures held to the answers of one kernel.

use crate::cases::{self, Reach, Shape, WIDE};
use crate::compare::Judged;
use accel::{RaySet, Scene, Workload};
use harness::guard::guard;
use primitives::KernelId;
use scenes::Random;

/// How much a case is at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    /// Rays of its list.
    pub(super) rays: u32,
    /// Structures that trace them.
    pub(super) structures: usize,
    /// Rays that the oracle sees where the kernel is the exact one.
    pub(super) exact: usize,
    /// Objects of the largest scenes.
    pub(super) largest: u32,
}

impl Size {
    pub(super) const USUAL: Self = Self { rays: 1 << 15, structures: 6, exact: 2048, largest: 20_000 };
}

/// What came out of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Case {
    pub(super) refused: bool,
    pub(super) threads: usize,
    /// Where rays were traced, and how far away the farthest of them began.
    pub(super) reach: Option<Reach>,
    pub(super) shape: String,
    /// What kind of rays.
    pub(super) kind: String,
    pub(super) objects: u64,
    pub(super) held: Vec<Held>,
    /// Of the rays of all that held.
    pub(super) hits: u64,
    pub(super) exact: u64,
    /// With the seed.
    pub(super) differences: Vec<String>,
}

/// A structure that answered as brute force did.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// Its id and kernel.
    pub(super) structure: String,
    /// Its instruction set.
    pub(super) level: String,
    pub(super) rays: u64,
}

impl Case {
    /// The case of this seed, in the current pool.
    pub(super) fn run(seed: u64, size: Size) -> Self {
        let mut case = Self { threads: rayon::current_num_threads(), ..Self::default() };
        if let Err(panic) = guard("a case", || case.fill(seed, size)) {
            case.differences.push(format!("seed {seed}: {panic}"));
        }
        case
    }

    fn fill(&mut self, seed: u64, size: Size) {
        let mut numbers = Random::new(seed);
        let reach = Reach::new(&mut numbers, &WIDE);
        let kernel = KernelId::ALL[numbers.below(KernelId::ALL.len())];
        let shape = cases::SHAPES[numbers.below(cases::SHAPES.len())];
        let (objects, most_rays) = extent(&mut numbers, size, shape, kernel);
        let Ok(scene) = cases::scene_of(&mut numbers, shape, &reach, objects) else {
            self.refused = true;
            return;
        };
        let (kind, rays, workload) = rays(&mut numbers, &scene, &reach, most_rays);
        if rays.is_empty() {
            self.refused = true;
            return;
        }
        self.shape = format!("{shape:?}");
        self.kind = kind.to_owned();
        self.objects = scene.geometry.len() as u64;
        self.reach = Some(Reach { origins: farthest(&scene, &rays), ..reach });
        let here =
            |what: &dyn std::fmt::Display| format!("seed {seed}, {reach:?}, {shape:?}, {kind}: {what}");
        let judged = match Judged::new(&scene, &rays, workload, kernel) {
            Ok(judged) => judged,
            Err(difference) => return self.differences.push(here(&difference)),
        };
        for _ in 0..size.structures {
            let spec = cases::structure(&mut numbers, kernel, 64);
            match judged.hold(&spec) {
                Ok(0) => self.held.push(Held::new(&spec, 0)),
                Ok(rays) => {
                    self.hits += judged.hits();
                    self.held.push(Held::new(&spec, rays));
                }
                Err(difference) => self.differences.push(here(&difference)),
            }
        }
        match judged.by_oracle(size.exact) {
            Ok(exact) => self.exact = exact,
            Err(difference) => self.differences.push(here(&difference)),
        }
    }
}

impl Held {
    fn new(spec: &str, rays: u64) -> Self {
        let parts: Vec<&str> = spec.split(',').collect();
        let level = parts.iter().find_map(|part| part.strip_prefix("simd=")).unwrap_or("default");
        Self { structure: parts[0].to_owned(), level: level.to_owned(), rays }
    }
}

/// Most objects and rays of a case. Large scenes have deep trees and take long; most of what goes wrong is seen in small ones.
/// The exact kernel compares what lies in one place with each other, hit by hit.
fn extent(numbers: &mut Random, size: Size, shape: Shape, kernel: KernelId) -> (u32, u32) {
    let meet = matches!(shape, Shape::Sheet | Shape::Repeated | Shape::OnLattice);
    match (numbers.below(256), kernel) {
        (0..8, KernelId::Exact) if !meet => (size.largest.min(1000), size.rays / 32),
        (_, KernelId::Exact) if meet => (24, size.rays / 8),
        (_, KernelId::Exact) => (80, size.rays / 4),
        (0, _) => (size.largest, size.rays / 8),
        (1..8, _) => (size.largest.min(2000), size.rays / 8),
        (8..100, _) => (200, size.rays),
        _ => (60, size.rays),
    }
}

/// A list, mostly of as many rays as may be, or an image, alone or beside rays of any kind.
fn rays(numbers: &mut Random, scene: &Scene, reach: &Reach, most: u32) -> (&'static str, RaySet, Workload) {
    let image = if numbers.below(4) == 0 { cases::image(numbers, scene, reach) } else { None };
    match image {
        Some(raster) if numbers.below(2) == 0 => ("image", RaySet::Raster(raster), Workload::raster(raster)),
        Some(raster) => ("both", RaySet::Raster(raster), Workload { raster: Some(raster), general: true }),
        None => {
            let count = match numbers.below(8) {
                0 => 1 + numbers.below(100),
                1 => 1 + numbers.below(most as usize),
                _ => most as usize,
            };
            ("list", RaySet::List(cases::rays(numbers, scene, reach, count)), Workload::GENERAL)
        }
    }
}

/// How far away from the scene's middle the farthest ray begins: at least two to this, in sizes of the scene.
fn farthest(scene: &Scene, rays: &RaySet) -> i32 {
    let bounds = scene.geometry.bounds();
    let (center, size) = (bounds.center().as_dvec3(), f64::from(bounds.extent().max_element()));
    let away = |ray: accel::Ray| (ray.origin.as_dvec3() - center).abs().max_element();
    let farthest = match rays {
        RaySet::List(list) => list.iter().map(|ray| away(*ray)).fold(0.0, f64::max),
        RaySet::Raster(_) => away(rays.ray(0)),
    };
    if size > 0.0 && farthest > 0.0 { (farthest / size).log2().floor() as i32 } else { 0 }
}
