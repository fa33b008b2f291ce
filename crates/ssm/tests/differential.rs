//! Both grids against brute force with the same kernel: not one bit may differ.

mod common;

use accel::{Builder, Counters, Geometry, Mesh, Ray, RaySet, Scene, Vec3, Workload};
use common::{boxes, cloud, compare, mesh, moved, rays, scene};
use lanes::Level;
use primitives::KernelId;
use proptest::prelude::*;
use ssm::suite::{Resolution, Settings, Ssm, SsmList};

/// All builders with these settings.
fn builders(settings: Settings) -> [Box<dyn Builder>; 5] {
    [
        Box::new(SsmList::new(settings)),
        Box::new(SsmList { mailbox: true, ..SsmList::new(settings) }),
        Box::new(Ssm { settings, divide: None }),
        Box::new(Ssm { settings, divide: Some(0.5) }),
        Box::new(Ssm { settings, divide: Some(3.0) }),
    ]
}

fn check(scene: &Scene, count: usize, settings: Settings) {
    let rays = rays(scene, count);
    for builder in builders(settings) {
        let built = builder.build(scene, &Workload::GENERAL).unwrap();
        let what = format!("{} {}", builder.id(), builder.settings());
        compare(scene, settings.kernel, &rays, &what, &*built);
    }
}

const DENSE: Resolution = Resolution::Density(8.0);

#[test]
fn every_instruction_set_and_number_of_threads() {
    let scene = cloud(700, 0.2);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for simd in Level::here() {
            for kernel in KernelId::ALL {
                let settings = Settings { simd, kernel, ..Settings::new(DENSE) };
                pool.install(|| check(&scene, 2000, settings));
            }
        }
    }
}

#[test]
fn every_resolution() {
    let scenes = [cloud(500, 0.1), cloud(60, 1.5), boxes(400, 0.3)];
    for slices in [[1; 3], [2; 3], [4; 3], [5; 3], [64; 3], [1, 7, 30], [33, 2, 1], [3, 1, 100]] {
        for scene in &scenes {
            check(scene, 1500, Settings::new(Resolution::Slices(slices)));
        }
    }
}

#[test]
fn boxes_of_groups_are_kept_where_they_part_rays() {
    for (scene, slices, kept) in [(cloud(3000, 0.02), 2, true), (cloud(600, 1.0), 16, false)] {
        let settings = Settings::new(Resolution::Slices([slices; 3]));
        let footprint = Ssm { settings, divide: None }.build(&scene, &Workload::GENERAL).unwrap().footprint();
        let of_boxes = footprint.parts.iter().find(|part| part.name == "boxes").map_or(0, |part| part.bytes);
        assert_eq!(of_boxes > 0, kept);
        check(&scene, 1500, settings);
    }
}

#[test]
fn extreme_scenes() {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let flat = mesh((0..200).map(|i| {
        let (x, y) = ((i % 20) as f32, (i / 20) as f32);
        [corner(x, y), corner(x + 1.0, y), corner(x, y + 1.0)]
    }));
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let scenes = [
        scene(Geometry::Triangles(Mesh::default())),
        scene(Geometry::Boxes(Vec::new())),
        mesh([triangle]),
        mesh([triangle; 100]),
        mesh([[Vec3::ONE; 3]; 3]),
        flat,
        boxes(1, 0.5),
        moved(cloud(200, 0.2), 1.0, Vec3::new(1.5e5, 1234.0, -2.2e5)),
        moved(cloud(200, 0.2), 1e-18, Vec3::ZERO),
        moved(cloud(200, 0.2), 1e15, Vec3::ZERO),
        moved(boxes(200, 0.2), 1e-4, Vec3::splat(1e3)),
    ];
    for scene in &scenes {
        for resolution in [DENSE, Resolution::Slices([4; 3]), Resolution::Slices([1, 9, 40])] {
            for kernel in KernelId::ALL {
                check(scene, 1500, Settings { kernel, ..Settings::new(resolution) });
            }
        }
    }
}

#[test]
fn ids_of_four_bytes_and_lists_that_are_sorted() {
    let scene = cloud(70_000, 0.02);
    check(&scene, 700, Settings::new(Resolution::Density(1.0)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_cloud_at_any_resolution(
        count in 1usize..200,
        size in prop_oneof![0.01f32..0.1, 0.5f32..3.0],
        slices in prop::array::uniform3(prop_oneof![1u32..6, 6u32..80]),
        stretch in 0.0f32..1.0,
    ) {
        let mut scene = cloud(count, size);
        if let Geometry::Triangles(mesh) = &mut scene.geometry {
            mesh.positions.iter_mut().for_each(|p| p.y *= stretch);
        }
        check(&scene, 400, Settings::new(Resolution::Slices(slices)));
    }
}

/// Rays towards a light from points side by side, as from the pixels of an image; here and there one goes elsewhere.
fn towards_a_light(scene: &Scene, count: u32) -> RaySet {
    let bounds = scene.geometry.bounds();
    let size = bounds.max - bounds.min;
    let light = bounds.max + size * 0.3;
    let ray = |i: u32| {
        let (x, y) = ((i % 64) as f32 / 64.0, (i / 64 % 64) as f32 / 64.0);
        let depth = if i.is_multiple_of(23) { 0.9 } else { 0.1 + 0.05 * x };
        let origin = bounds.min + size * Vec3::new(x, y, depth);
        let to = if i.is_multiple_of(37) { origin - size } else { light };
        Ray { origin, direction: to - origin, t_min: 1e-4, t_max: 1.0 }
    };
    RaySet::List((0..count).map(ray).collect())
}

#[test]
fn neighbours_that_go_together_meet_what_each_meets_alone() {
    let thin = moved(cloud(3000, 0.02), 1.0, Vec3::splat(40.0));
    for scene in [cloud(3000, 0.02), cloud(800, 0.1), thin, boxes(2000, 0.03)] {
        let rays = towards_a_light(&scene, 4096);
        for simd in Level::here() {
            // The first two keep boxes of groups in one scene at least, without which rays go by themselves.
            for resolution in [Resolution::Slices([2; 3]), Resolution::Slices([3, 2, 4]), DENSE] {
                let settings = Settings { simd, ..Settings::new(resolution) };
                for divide in [None, Some(0.5), Some(3.0)] {
                    let ssm = Ssm { settings, divide };
                    let built = ssm.build(&scene, &Workload::GENERAL).unwrap();
                    compare(&scene, settings.kernel, &rays, &format!("{settings:?} {divide:?}"), &*built);
                }
            }
        }
    }
}

#[test]
fn neighbours_that_go_together_look_at_fewer_cells() {
    let scene = cloud(3000, 0.02);
    let rays = towards_a_light(&scene, 4096);
    let settings = Settings::new(Resolution::Slices([2; 3]));
    let built = Ssm { settings, divide: None }.build(&scene, &Workload::GENERAL).unwrap();
    let many = built.count(&rays, true).unwrap();
    let alone = (0..rays.len()).map(|i| built.count(&RaySet::List(vec![rays.ray(i)]), true).unwrap());
    let alone = alone.fold(Counters::default(), |mut sum, counters| {
        sum.merge(&counters);
        sum
    });
    assert!(2 * many.cells < alone.cells, "{} and {}", many.cells, alone.cells);
}

#[test]
fn rays_that_meet_what_is_set_apart_look_at_no_cell() {
    let scene = with_a_wall(3000);
    let settings = Settings::new(Resolution::Slices([4; 3]));
    let built = Ssm { settings, divide: None }.build(&scene, &Workload::GENERAL).unwrap();
    assert!(built.plan().contains("the largest objects set apart"));
    // Every third ray goes away from the wall.
    let ray = |i: u16| {
        let origin = Vec3::new(f32::from(i % 50) / 100.0, f32::from(i / 50) / 100.0, 0.5);
        Ray::new(origin, if i.is_multiple_of(3) { Vec3::NEG_Z } else { Vec3::Z })
    };
    let all: Vec<Ray> = (0..1000).map(ray).collect();
    let towards = RaySet::List(all.iter().copied().filter(|ray| ray.direction.z > 0.0).collect());
    assert_eq!(built.count(&towards, true).unwrap().cells, 0);
    compare(&scene, settings.kernel, &towards, "towards a wall", &*built);
    compare(&scene, settings.kernel, &RaySet::List(all), "towards a wall and away", &*built);
}

/// A cloud, and a wall behind it that is longer than it.
fn with_a_wall(count: usize) -> Scene {
    let mut scene = cloud(count, 0.02);
    if let Geometry::Triangles(mesh) = &mut scene.geometry {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([(-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)].map(|(x, y)| Vec3::new(x, y, 1.5)));
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    scene
}
