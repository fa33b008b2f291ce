//! Planted faults: a check that the suite relies on must find each of them, and find nothing in
//! the same structure without the fault.

use accel::dda::Walk;
use accel::grid::Grid;
use accel::{
    Aabb, Accel, BuildError, Builder, Cancel, Footprint, Geometry, Hit, Mesh, Nearest, Objects, Ray, Scene,
    Surface, Workload,
};
use bmssm::suite::general::{General, Settings};
use harness::registry::{Choice, ChosenKernel, Entry};
use harness::sweeps::{differences, leaks, oracle};
use harness::workload::Subject;
use lanes::packet::Lanes;
use lanes::{Level, PackedObjects, Simd};
use primitives::kernel::{Many, Packed, Watertight};
use primitives::{Kernel, KernelId, Triangles};
use scenes::rays::RaysId;
use std::sync::Arc;

/// Woop, Benthin and Wald's test with > for ≥ at the edges.
#[derive(Clone, Copy, Debug, Default)]
struct OpenEdges;

#[inline(always)]
fn without_edges<S: Simd>(s: S, lanes: Lanes<S>) -> Lanes<S> {
    let (zero, one) = (s.splat(0.0), s.splat(1.0));
    let inside = s.and(s.lt(zero, lanes.u), s.lt(zero, lanes.v));
    let inside = s.and(inside, s.lt(s.add(lanes.u, lanes.v), one));
    Lanes { hit: s.and(lanes.hit, inside), ..lanes }
}

impl Kernel for OpenEdges {
    const ID: KernelId = KernelId::Watertight;
    primitives::plain_kernel!();
    type One = <Watertight as Kernel>::One;

    fn triangles<S: Simd>(s: S, ray: &Self::One, packed: Packed<'_>, wanted: u32, t_max: f32) -> Lanes<S> {
        without_edges(s, Watertight::triangles(s, ray, packed, wanted, t_max))
    }

    fn rays<S: Simd>(s: S, rays: &Many<Self, S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        without_edges(s, Watertight::rays(s, rays, packed, t_max))
    }
}

/// Every triangle tested for every ray.
struct All<O>(O);

impl<O: Objects> Accel for All<O> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut best = Nearest::new(ray.t_max);
        (0..self.0.len() as u32).for_each(|id| self.0.closest(id, ray, &mut best));
        best.hit()
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
    }
}

/// Triangles whose boxes are rounded to a lattice before they are entered in maps: outwards, or the wrong way.
#[derive(Clone, Copy)]
struct Rounded<'s> {
    triangles: Triangles<'s, Watertight>,
    low: f32,
    step: f32,
    inwards: bool,
}

impl<'s> Rounded<'s> {
    fn new(mesh: &'s Mesh, inwards: bool) -> Self {
        let bounds = mesh.bounds();
        let step = bounds.extent().max_element() / 256.0;
        Self { triangles: Triangles::new(mesh), low: bounds.min.min_element(), step, inwards }
    }
}

impl<'s> Objects for Rounded<'s> {
    fn len(&self) -> usize {
        self.triangles.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        let Aabb { min, max } = self.triangles.bounds(id);
        let [low, high] = [min, max].map(|v| (v - self.low) / self.step);
        let (low, high) = if self.inwards { (low.ceil(), high.floor()) } else { (low.floor(), high.ceil()) };
        let back = |v: accel::Vec3| v * self.step + self.low;
        let (min, max) =
            if self.inwards { (back(low), back(high)) } else { (back(low).min(min), back(high).max(max)) };
        Aabb { min: min.min(max), max: min.max(max) }
    }

    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        self.triangles.intersect(id, ray, t_max)
    }
}

impl<'s> PackedObjects for Rounded<'s> {
    type Blocks = <Triangles<'s, Watertight> as PackedObjects>::Blocks;

    type Shape = Self;

    fn shape(&self) -> Self {
        *self
    }

    fn blocks(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError> {
        self.triangles.blocks(structure, order)
    }
}

/// The maps of `bmssm` over rounded boxes.
struct Maps<'s>(General<Rounded<'s>>);

impl Accel for Maps<'_> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut hit = [None];
        self.0.closest(std::slice::from_ref(ray), &mut hit);
        hit[0]
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
    }
}

/// A plain uniform grid. Its walk passes every cell, or steps across the corner of those that it meets only there.
struct Cells<'s> {
    triangles: Triangles<'s, Watertight>,
    grid: Grid,
    lists: Vec<Vec<u32>>,
    skips_corners: bool,
}

impl<'s> Cells<'s> {
    fn new(mesh: &'s Mesh, skips_corners: bool) -> Self {
        let triangles = Triangles::<Watertight>::new(mesh);
        let boxes: Vec<Aabb> = (0..triangles.len() as u32).map(|id| triangles.bounds(id)).collect();
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        let grid = Grid::new(bounds, [10; 3]).unwrap();
        let mut lists = vec![Vec::new(); grid.cells() as usize];
        for (id, b) in boxes.iter().enumerate() {
            let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.slices(axis, b));
            for z in zs {
                for y in ys.clone() {
                    xs.clone().for_each(|x| lists[grid.index([x, y, z])].push(id as u32));
                }
            }
        }
        Self { triangles, grid, lists, skips_corners }
    }
}

/// A cell counts as met at a corner if the ray passes this share of its way in it.
const CORNER: f32 = 4e-2;

impl Accel for Cells<'_> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut best = Nearest::new(ray.t_max);
        let segment = self.grid.clip(ray)?;
        for cell in Walk::new(&self.grid, &segment) {
            if cell.enter > segment.limit(best.t) {
                break;
            }
            if self.skips_corners && cell.exit - cell.enter < CORNER {
                continue;
            }
            for id in &self.lists[self.grid.index(cell.slice)] {
                self.triangles.closest(*id, ray, &mut best);
            }
        }
        best.hit()
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
    }
}

/// A structure with or without its fault.
#[derive(Clone, Copy)]
enum Planted {
    Kernel { open_edges: bool },
    Maps { inwards: bool },
    Walk { skips_corners: bool },
}

impl Builder for Planted {
    fn id(&self) -> &str {
        "planted"
    }

    fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        let Geometry::Triangles(mesh) = &scene.geometry else {
            return Err(BuildError::Unsupported { structure: "planted".into(), what: "boxes".into() });
        };
        Ok(match *self {
            Self::Kernel { open_edges: true } => Box::new(All(Triangles::<OpenEdges>::new(mesh))),
            Self::Kernel { open_edges: false } => Box::new(All(Triangles::<Watertight>::new(mesh))),
            Self::Maps { inwards } => {
                let settings = Settings {
                    simd: Level::best(),
                    exact_split: 1024,
                    storage: bmssm::suite::general::Storage::Rows,
                };
                Box::new(Maps(General::new(&Rounded::new(mesh, inwards), settings, Cancel::NEVER)?))
            }
            Self::Walk { skips_corners } => Box::new(Cells::new(mesh, skips_corners)),
        })
    }
}

fn choice(planted: Planted) -> Choice {
    static ENTRY: Entry = Entry::new("planted", |_| unreachable!("made by the test"));
    Choice {
        spec: "planted".parse().unwrap(),
        entry: &ENTRY,
        kernel: ChosenKernel::Given(KernelId::Watertight),
        builder: Arc::new(planted),
    }
}

/// Differences from brute force, by the differential sweep.
fn differences(planted: Planted) -> u64 {
    let rays = RaysId::ALL.into_iter().filter(|id| !id.is_image()).collect();
    let subject = Subject { scenes: vec!["bumps-2k".into()], rays, size: 24, seed: 1 };
    let plan = differences::Sweep { subject, rays_each: 0, tests: u64::MAX };
    let tally = differences::run(&plan, &[choice(planted)], ()).unwrap();
    let row = &tally.structures[0];
    assert!(row.rays > 1000, "{row:?}");
    assert_eq!(tally.is_sound(), row.differences == 0, "{:?}", tally.findings);
    row.differences
}

/// Missed hits, by the oracle: a few where the kernel itself is wrong, at edges seen from the side.
fn missed(planted: Planted) -> u64 {
    let rays = vec![RaysId::Random, RaysId::Edge, RaysId::LeakEdge, RaysId::LeakVertex, RaysId::LeakFace];
    missed_of(planted, "bumps-2k", rays, 32)
}

fn missed_of(planted: Planted, scene: &str, rays: Vec<RaysId>, size: u32) -> u64 {
    let plan =
        oracle::OraclePlan { subject: Subject { scenes: vec![scene.into()], rays, size, seed: 1 }, least: 0 };
    let tally = oracle::run(&plan, &[choice(planted)], ()).unwrap();
    assert!(tally.rays > 5000, "{tally:?}");
    tally.structures[0].missed
}

/// Rays that get out of closed meshes, by the leak check.
fn leaked(planted: Planted, rays: u64) -> u64 {
    let tally = leaks::run(rays, 1, &[choice(planted)], ()).unwrap();
    let sum: u64 = tally.sums().iter().flat_map(|(_, _, leaks)| leaks).sum();
    assert_eq!(tally.is_tight(), sum == 0);
    sum
}

/// All three checks find a fault, and two nothing without it.
fn found_by_all(plant: impl Fn(bool) -> Planted, rays: u64) {
    let [sound, faulty] = [false, true].map(plant);
    assert_eq!((differences(sound), leaked(sound, rays)), (0, 0));
    assert!(differences(faulty) > 0, "by the sweep");
    assert!(missed(faulty) > missed(sound), "by the oracle");
    assert!(leaked(faulty, rays) > 0, "by the leak check");
}

#[test]
fn a_kernel_without_its_edges_is_found() {
    found_by_all(|open_edges| Planted::Kernel { open_edges }, 300);
}

#[test]
fn maps_rounded_the_wrong_way_are_found() {
    found_by_all(|inwards| Planted::Maps { inwards }, 2000);
}

/// Rays of which some hit an object in a cell that they meet near a corner only.
const MANY: u64 = 60_000;

#[test]
fn a_walk_that_skips_corner_cells_is_found() {
    let [sound, faulty] = [false, true].map(|skips_corners| Planted::Walk { skips_corners });
    assert_eq!((differences(sound), leaked(sound, MANY)), (0, 0));
    assert!(differences(faulty) > 0, "by the sweep");
    let side = (MANY as f64).sqrt() as u32;
    let missed = [sound, faulty].map(|walk| missed_of(walk, "bumps-20k", vec![RaysId::Random], side));
    assert!(missed[1] > missed[0], "by the oracle: {missed:?}");
    assert!(leaked(faulty, MANY) > 0, "by the leak check");
}
