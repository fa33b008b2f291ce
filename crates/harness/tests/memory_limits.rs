//! Grids and dense maps never take more memory than they may, on the way to being built included.

use accel::{Geometry, Mesh, Scene, Vec3, View, Workload};
use harness::registry::{self, guarded_build};

#[global_allocator]
static ALLOCATOR: heap::Counting = heap::Counting;

/// Triangles across the whole scene, or small ones.
fn scene(size: f32) -> Scene {
    let mut random = scenes::Random::new(5);
    let mut point = || Vec3::new(random.unit() as f32, random.unit() as f32, random.unit() as f32);
    let mut mesh = Mesh::default();
    for i in 0..600 {
        let corner = point();
        mesh.positions.extend([corner, corner + (point() - 0.5) * size, corner + (point() - 0.5) * size]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "limits".into(), geometry: Geometry::Triangles(mesh), view }
}

/// What threads and libraries allocate once, beside a structure's own.
const ROOM: u64 = 128 << 10;

/// Alone in its file: other tests' allocations would count as well.
#[test]
fn peaks_are_within_limits() {
    heap::start_counting();
    let mut wrong = Vec::new();
    let (mut built, mut refused) = (0, 0);
    for scene in [scene(1.0), scene(0.05)] {
        for structure in [
            "ssm",
            "ssm:resolution=24",
            "ssm:resolution=96,divide=1",
            "ssm:resolution=16,divide=0.5",
            "ssm-list",
            "ssm-list:resolution=48",
            "bmssm-dense:resolution=300",
        ] {
            for limit in [50_000u64, 300_000, 1_000_000, 5_000_000, 30_000_000] {
                let spec: registry::StructureSpec = structure.parse().unwrap();
                let choice = registry::choose(&spec.with("memory", &limit.to_string())).unwrap();
                let build = || guarded_build(&choice, &scene, &Workload::GENERAL).map(drop);
                let (made, used) = heap::observe(build);
                let used = used.expect("counting");
                match made {
                    Ok(()) => built += 1,
                    Err(failure) if failure.is_too_large() => refused += 1,
                    Err(failure) => wrong.push(format!("{structure} with {limit}: {failure}")),
                }
                if used.peak > limit + limit / 20 + ROOM {
                    wrong.push(format!("{structure} with {limit}: took {}", used.peak));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(built > 20 && refused > 20, "{built} built, {refused} refused");
}
