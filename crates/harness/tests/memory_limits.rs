//! Grids and dense maps never take more memory than they may, on the way to being built included.

use accel::{Geometry, Mesh, Raster, Scene, Vec3, View, Workload};
use harness::registry::{self, guarded_build};

#[global_allocator]
static ALLOCATOR: heap::Counting = heap::Counting;

/// Triangles across the whole scene, or small ones.
fn scene(size: f32) -> Scene {
    scene_of(600, size)
}

fn scene_of(triangles: u32, size: f32) -> Scene {
    let mut random = scenes::Random::new(5);
    let mut point = || Vec3::new(random.unit() as f32, random.unit() as f32, random.unit() as f32);
    let mut mesh = Mesh::default();
    for i in 0..triangles {
        let corner = point();
        mesh.positions.extend([corner, corner + (point() - 0.5) * size, corner + (point() - 0.5) * size]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "limits".into(), geometry: Geometry::Triangles(mesh), view }
}

/// What threads and libraries allocate once, beside a structure's own.
const ROOM: u64 = 128 << 10;

/// A structure, a scene and a workload at different limits.
struct Limited<'a> {
    structure: &'a str,
    scene: &'a Scene,
    workload: &'a Workload,
}

impl Limited<'_> {
    /// Whether it is built, and the most bytes in use meanwhile.
    fn at(&self, limit: u64) -> (Result<bool, String>, u64) {
        let spec: registry::StructureSpec = self.structure.parse().unwrap();
        let choice = registry::choose(&spec.with("memory", &limit.to_string())).unwrap();
        let (made, used) = heap::observe(|| guarded_build(&choice, self.scene, self.workload).map(drop));
        let built = match made {
            Ok(()) => Ok(true),
            Err(failure) if failure.is_too_large() => Ok(false),
            Err(failure) => Err(failure.to_string()),
        };
        (built, used.expect("counting").peak)
    }

    /// What is wrong with a limit, or whether it was built.
    fn check(&self, limit: u64) -> Result<bool, String> {
        let here = |what: String| {
            format!("{} over {} with {limit}: {what}", self.structure, self.scene.geometry.len())
        };
        let (built, peak) = self.at(limit);
        if peak > limit + limit / 20 + ROOM {
            return Err(here(format!("took {peak}")));
        }
        built.map_err(here)
    }
}

/// Alone in its file: other tests' allocations would count as well.
#[test]
fn peaks_are_within_limits() {
    heap::start_counting();
    let mut wrong = Vec::new();
    let (mut built, mut refused) = (0, 0);
    let mut note = |checked| match checked {
        Ok(true) => built += 1,
        Ok(false) => refused += 1,
        Err(what) => wrong.push(what),
    };
    for scene in &[scene(1.0), scene(0.05)] {
        for structure in [
            "bmssm",
            "ssm",
            "ssm:resolution=24",
            "ssm:resolution=96,divide=1",
            "ssm:resolution=16,divide=0.5",
            "ssm-list",
            "ssm-list:resolution=48",
            "bmssm-dense:resolution=300",
        ] {
            for limit in [50_000u64, 300_000, 1_000_000, 5_000_000, 30_000_000] {
                note(Limited { structure, scene, workload: &Workload::GENERAL }.check(limit));
            }
        }
    }
    // Scenes and images of which the phases of building take turns to take most.
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            for (triangles, size) in [(1, 0.1), (600, 0.05), (5000, 1.0), (70_000, 0.01)] {
                let scene = &scene_of(triangles, size);
                let image = |side| Workload::raster(Raster::perspective(&scene.view, side, side));
                let both = Workload { general: true, ..image(64) };
                for (structure, workload) in [
                    ("bmssm", Workload::GENERAL),
                    ("bmssm:kernel=exact", Workload::GENERAL),
                    ("bmssm:geometry=scene", Workload::GENERAL),
                    ("bmssm:geometry=boxes", Workload::GENERAL),
                    ("bmssm", image(64)),
                    ("bmssm:kernel=exact,tile=1", image(1024)),
                    ("bmssm", both),
                ] {
                    let workload = &workload;
                    let limited = Limited { structure, scene, workload };
                    let (_, peak) = limited.at(1 << 40);
                    // At what it takes at most, or not much above, it is built.
                    for part in [0.1, 0.5, 0.8, 0.93, 1.0, 1.3] {
                        note(limited.check((peak as f64 * part) as u64));
                    }
                    let roomy = peak + peak / 2 + ROOM;
                    if !matches!(limited.at(roomy), (Ok(true), _)) {
                        note(Err(format!(
                            "{structure} over {triangles} ({workload:?}): refused at {roomy}, takes {peak}"
                        )));
                    }
                }
            }
        });
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(built > 20 && refused > 20, "{built} built, {refused} refused");
}
