//! Every large allocation of a grid or of dense maps, refused one after another: building ends by an error, and keeps nothing.

use accel::{Geometry, Mesh, Scene, Vec3, View, Workload};
use harness::registry::{self, guarded_build};

#[global_allocator]
static ALLOCATOR: heap::Counting = heap::Counting;

/// Above what 300 objects themselves take: what grows with cells, references and slices is larger.
const LARGE: usize = 1 << 15;

fn scene() -> Scene {
    let mut random = scenes::Random::new(7);
    let mut point = || Vec3::new(random.unit() as f32, random.unit() as f32, random.unit() as f32);
    let mut mesh = Mesh::default();
    for i in 0..300 {
        let corner = point();
        mesh.positions.extend([corner, corner + (point() - 0.5) * 0.2, corner + (point() - 0.5) * 0.2]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "allocations".into(), geometry: Geometry::Triangles(mesh), view }
}

/// Alone in its file: other tests' allocations would be counted and refused as well.
#[test]
fn refused_memory_is_an_error_and_nothing_is_kept() {
    heap::start_counting();
    let scene = scene();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for (structure, least) in [
        ("ssm:resolution=64,divide=off", 3),
        ("ssm-list:resolution=48", 3),
        ("bmssm-dense:resolution=4096", 3),
    ] {
        let choice = registry::parse(structure).unwrap();
        let build = || guarded_build(&choice, &scene, &Workload::GENERAL).map(drop);
        alone.install(build).unwrap();
        let mut refused = 0;
        loop {
            let ((made, came), used) = heap::observe(|| {
                heap::refusing(refused, LARGE, || {
                    alone.install(build).map_err(|failure| failure.is_too_large())
                })
            });
            assert_eq!(made, if came { Err(true) } else { Ok(()) }, "{structure}, allocation {refused}");
            assert_eq!(used.expect("counting").left, 0, "{structure}, allocation {refused}");
            if !came {
                break;
            }
            refused += 1;
        }
        assert!(refused >= least, "{structure}: {refused} large allocations");
    }
}
