//! What tests of this crate share: small scenes, rays, cells and records.

use crate::machine::Machine;
use crate::record::*;
pub use accel::testing::random;
use accel::{Geometry, Mesh, Projection, Raster, Ray, RaySet, Scene, Vec3, View};
use primitives::KernelId;
use scenes::rays::{RaysId, RaysSpec, generate};

fn scene(id: &str, mesh: Mesh) -> Scene {
    let view = View { eye: Vec3::Z * 4.0, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: id.into(), geometry: Geometry::Triangles(mesh), view }
}

/// A cloud of triangles and rays that start in and around it.
pub fn cloud(triangles: u32, rays: u32) -> (Scene, RaySet) {
    let (cloud, rays) = accel::testing::cloud(triangles, rays);
    let view = View { eye: Vec3::Z * 4.0, ..cloud.view };
    (Scene { id: "cloud".into(), view, ..cloud }, rays)
}

/// A bumpy sphere far from the origin and 1,600 rays at its corners, which tests in `f32` often get wrong.
pub fn distant_corners() -> (Scene, RaySet) {
    let scene =
        scenes::load(&"bumps-1k@offset=1e5,0,0".parse().expect("a scene's name")).expect("a generated scene");
    let tracer = crate::registry::quick(&scene, KernelId::Exact);
    let spec = RaysSpec { id: RaysId::LeakVertex, rows: 40, cols: 40, seed: 1 };
    let rays = generate(&scene, &spec, tracer.as_ref()).expect("corners to aim at");
    drop(tracer);
    (scene, rays)
}

/// An octahedron around the origin, and rays from its inside.
pub fn from_inside(rays: u32) -> (Scene, RaySet) {
    let positions = vec![Vec3::X, Vec3::Y, -Vec3::X, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let triangles = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]).collect();
    let mut random = random(11);
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let rays = (0..rays).map(|_| Ray::new(point(0.2), point(1.0))).collect();
    (scene("octahedron", Mesh { positions, triangles }), RaySet::List(rays))
}

/// Rays that miss everything near the origin.
pub fn away(rays: u32) -> RaySet {
    let mut random = random(13);
    let ray = |_| Ray::new(Vec3::new(random(), random(), 9.0), Vec3::new(random(), random(), 1.0));
    RaySet::List((0..rays).map(ray).collect())
}

/// A parallel raster over the square [-1, 1]².
pub fn raster(rows: u32, cols: u32) -> Raster {
    Raster {
        projection: Projection::Parallel,
        rows,
        cols,
        origin: Vec3::new(-1.0, 1.0, 4.0),
        forward: Vec3::NEG_Z,
        right: Vec3::X * (2.0 / cols as f32),
        down: Vec3::NEG_Y * (2.0 / rows as f32),
    }
}

/// A cell that took `ns` per ray: five samples of 1000 rays within 2 %.
pub fn cell(scene: &str, rays: &str, structure: &str, ns: f64) -> Cell {
    let samples = [1.0, 1.01, 0.99, 1.02, 0.98].map(|f| (ns * f * 1000.0) as u64);
    let mut cell = Cell {
        scene: scene.into(),
        rays: rays.into(),
        query: Query::Closest,
        structure: structure.into(),
        kernel: Intersector::BuiltIn(KernelId::MollerTrumbore),
        kernel_reason: String::new(),
        threads: 1,
        ray_count: 1000,
        hits: 700,
        build_ns: vec![3_000_000, 3_100_000, 2_900_000],
        trace_ns: samples.to_vec(),
        passes: Vec::new(),
        ns_per_ray: None,
        bytes: Some(Bytes {
            structure: 4096,
            geometry_copy: 2048,
            peak_build: Some(8192),
            allocated: Some(6144),
            parts: [("cells".to_owned(), 4096), ("blocks".to_owned(), 2048)].into(),
        }),
        plan: String::new(),
        counters: None,
        check: Some(Check { rays_checked: 1000, differences: 0, errors: None }),
        outcome: Outcome::Measured,
    };
    cell.summarise();
    cell
}

/// A record of two scenes, two ray sets and three structures, one cell of which failed.
pub fn record() -> Record {
    let structure = |id: &str| Structure {
        id: id.into(),
        version: "1.2.3".into(),
        settings: "kernel=moller-trumbore".into(),
        description: format!("structure {id}"),
    };
    let scene = |id: &str, objects| SceneEntry {
        id: id.into(),
        objects,
        kind: "triangles".into(),
        source: "generated, seed 1".into(),
        checksum: "00ff".into(),
    };
    let mut cells = Vec::new();
    for (scene, slow) in [("one", 1.0), ("two", 4.0)] {
        for (rays, share) in [("parallel", 1.0), ("random", 2.0)] {
            for (structure, ns) in [("a", 10.0), ("b", 20.0), ("c", 5.0)] {
                cells.push(cell(scene, rays, structure, ns * slow * share));
            }
        }
    }
    // c fails once: comparisons with it must leave that cell out for all.
    cells[5].outcome = Outcome::Failed("it fell over".into());
    Record {
        format: FORMAT,
        started_unix: 1_700_000_000,
        command: "rayscale measure".into(),
        suite: Suite {
            version: "0.1.0".into(),
            git: "abc".into(),
            profile: "release".into(),
            rustflags: String::new(),
            rustc: "rustc 1".into(),
        },
        machine: Machine {
            cpu: "cpu".into(),
            isa: "isa".into(),
            cores: 2,
            os: "os".into(),
            memory_bytes: 1 << 30,
            flush_to_zero: false,
            denormals_are_zero: false,
        },
        run: None,
        structures: ["a", "b", "c"].map(structure).into(),
        scenes: vec![scene("one", 1000), scene("two", 20_000)],
        cells,
        memory: vec![MemoryRow::by_formula("one", 1000, 32, 1.0)],
        skipped: vec![Skipped { id: "embree".into(), reason: "not here".into() }],
    }
}
