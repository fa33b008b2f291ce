//! The reference methods against the reference.

use accel::{Builder, Geometry, Mesh, Need, Ray, RaySet, Scene, Vec3, View};
use baselines::{Brute, MinMax, Sphere};
use primitives::KernelId;

/// A deterministic cloud of triangles and rays that start in, on and outside of it.
fn cloud(triangles: u32, rays: u32) -> (Scene, RaySet) {
    let mut state = 7u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 * 2.0 - 1.0
    };
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let mut mesh = Mesh::default();
    for i in 0..triangles {
        let center = point(1.0);
        mesh.positions.extend([center, center + point(0.3), center + point(0.3)]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let rays = (0..rays).map(|i| Ray::new(point(if i % 3 == 0 { 3.0 } else { 1.0 }), point(1.0))).collect();
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    (Scene { id: "cloud".into(), geometry: Geometry::Triangles(mesh), view }, RaySet::List(rays))
}

#[test]
fn bounding_volumes_lose_nothing() {
    let (scene, rays) = cloud(500, 3000);
    for kernel in KernelId::ALL {
        let mut reference = vec![None; rays.len()];
        Brute::new(kernel).build(&scene, &Need::GENERAL).unwrap().trace(&rays, &mut reference);
        assert!(reference.iter().flatten().count() > 500);
        for builder in [&MinMax { kernel } as &dyn Builder, &Sphere { kernel }] {
            let built = builder.build(&scene, &Need::GENERAL).unwrap();
            let mut hits = vec![None; rays.len()];
            built.trace(&rays, &mut hits);
            assert_eq!(hits, reference, "{} {kernel}", builder.id());
            let mut occluded = vec![false; rays.len()];
            built.trace_occluded(&rays, &mut occluded);
            assert!(occluded.iter().zip(&reference).all(|(o, hit)| *o == hit.is_some()));
            let counters = built.count(&rays, false).unwrap();
            assert_eq!(counters.candidates, 500 * 3000);
            assert!(counters.tests < counters.candidates / 2, "the volumes reject most objects");
        }
    }
}

#[test]
fn an_empty_scene_has_no_hits() {
    let (scene, rays) = cloud(0, 10);
    for builder in
        [&Brute::new(KernelId::Watertight) as &dyn Builder, &MinMax { kernel: KernelId::Watertight }]
    {
        let mut hits = vec![None; rays.len()];
        builder.build(&scene, &Need::GENERAL).unwrap().trace(&rays, &mut hits);
        assert!(hits.iter().all(Option::is_none));
    }
}
