//! Every large allocation of a build, refused one after another: building ends by an error, and keeps nothing.

use accel::{Geometry, Mesh, Raster, Ray, RaySet, Scene, Vec3, View, Workload};
use harness::registry::{self, Choice, guarded_build};

#[global_allocator]
static ALLOCATOR: heap::Counting = heap::Counting;

/// Above what 300 objects themselves take: what grows with cells, references and slices is larger.
const LARGE: usize = 1 << 15;

/// Above what a structure itself takes and what one task of rayon's does.
const SMALL: usize = 1 << 11;

fn scene(triangles: u32) -> Scene {
    let mut random = scenes::Random::new(7);
    let mut point = || Vec3::new(random.unit() as f32, random.unit() as f32, random.unit() as f32);
    let mut mesh = Mesh::default();
    for i in 0..triangles {
        let corner = point();
        mesh.positions.extend([corner, corner + (point() - 0.5) * 0.2, corner + (point() - 0.5) * 0.2]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let (eye, target) = (Vec3::new(0.5, 0.5, 3.0), Vec3::splat(0.5));
    let view = View { eye, target, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "allocations".into(), geometry: Geometry::Triangles(mesh), view }
}

/// Alone in its file: other tests' allocations would be counted and refused as well.
#[test]
fn refused_memory_is_an_error_and_nothing_is_kept() {
    heap::start_counting();
    let (few, some, many) = (scene(300), scene(1000), scene(12_000));
    let image = Raster::perspective(&few.view, 64, 64);
    // Kept to the end: threads that end give back what they took.
    let pools = [1, 3].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap());
    let both = Workload { raster: Some(image), general: true };
    // At least so many: how often a thread's buffers grow depends on the order in which it gets parts of different sizes.
    for (structure, scene, workload, least) in [
        ("ssm:resolution=64,divide=off", &few, Workload::GENERAL, 3),
        ("ssm-list:resolution=48", &few, Workload::GENERAL, 3),
        ("bmssm-dense:resolution=4096", &few, Workload::GENERAL, 3),
        ("bmssm", &many, Workload::GENERAL, 15),
        ("bmssm:geometry=scene,kernel=exact", &many, Workload::GENERAL, 14),
        ("bmssm", &many, Workload::raster(image), 6),
        ("bmssm", &many, both, 21),
    ] {
        for pool in &pools {
            let refused = refuse_each(structure, scene, &workload, pool, LARGE);
            assert!(refused >= least, "{structure}: {refused} large allocations");
        }
    }
    // All that grows, in the trees of divided cells too. With a limit, for to ask the system how much there is may fail too.
    for (structure, scene, least) in [
        ("ssm:memory=1000000000", &many, 6),
        ("ssm:resolution=3,divide=1,memory=1000000000", &some, 20),
        ("ssm-list:memory=1000000000", &many, 3),
    ] {
        for pool in &pools {
            let refused = refuse_each(structure, scene, &Workload::GENERAL, pool, SMALL);
            assert!(refused >= least, "{structure}: {refused} allocations that are not small");
        }
    }
}

/// How many allocations there were to be refused.
fn refuse_each(
    structure: &str,
    scene: &Scene,
    workload: &Workload,
    pool: &rayon::ThreadPool,
    bytes: usize,
) -> usize {
    let choice = registry::parse(structure).unwrap();
    let build = || guarded_build(&choice, scene, workload).map(drop);
    // What threads allocate once, at their first task, belongs to no build.
    (0..3).for_each(|_| pool.install(build).unwrap());
    let mut refused = 0;
    loop {
        let ((made, came), used) = heap::observe(|| {
            heap::refusing(refused, bytes, || pool.install(build).map_err(|failure| failure.is_too_large()))
        });
        assert_eq!(made, if came { Err(true) } else { Ok(()) }, "{structure}, allocation {refused}");
        let left = used.expect("counting").left;
        // Queues of tasks may grow while others take from them.
        let few = if pool.current_num_threads() == 1 { 0 } else { 1 << 12 };
        assert!(left.abs() <= few, "{structure}, allocation {refused}: {left} bytes are left");
        if !came {
            pool.install(|| answers_as_brute_force(&choice, scene, workload));
            return refused;
        }
        refused += 1;
    }
}

/// What is built after all refusals is sound.
fn answers_as_brute_force(choice: &Choice, scene: &Scene, workload: &Workload) {
    let place = |i: u16, step: f32| (f32::from(i) * step).fract();
    let origin = |i| Vec3::new(-0.3, place(i, 0.618), place(i, 0.414));
    let list = (0..500).map(|i| Ray::new(origin(i), Vec3::new(1.0, 0.1, -0.05)));
    let rays = workload.raster.map_or_else(|| RaySet::List(list.collect()), RaySet::Raster);
    let brute = format!("brute:kernel={}", choice.built_in_kernel().unwrap());
    let of = |choice: &Choice| {
        let mut hits = vec![None; rays.len()];
        guarded_build(choice, scene, workload).unwrap().trace(&rays, &mut hits);
        hits
    };
    let hits = of(choice);
    assert!(hits.iter().flatten().count() > 50);
    assert_eq!(hits, of(&registry::parse(&brute).unwrap()));
}
