//! Rays that come from far away, up to the distance that [`accel::tolerance::FAR`] promises: every structure answers what brute
//! force does, and with the exact kernel that is the truth.

use accel::tolerance::FAR;
use accel::{Accel, Builder, Geometry, Hit, Mesh, Ray, RaySet, Scene, Vec3, View, Workload};
use baselines::Brute;
use harness::registry;
use oracle::{Verdict, classify};
use primitives::KernelId;
use scenes::SceneSpec;

fn load(id: &str) -> Scene {
    scenes::load(&id.parse::<SceneSpec>().unwrap()).unwrap()
}

/// Rays whose lines pass the origin of coordinates without error, from about 2^`power` away.
fn rays(power: i32, count: u64) -> Vec<Ray> {
    let mut random = scenes::Random::new(power.unsigned_abs().into());
    let far = 2f32.powi(power);
    let mut number = || (random.bits() % 509) as f32 - 254.0;
    (0..count)
        .map(|_| Vec3::new(number(), number(), number()))
        .filter(|direction| *direction != Vec3::ZERO)
        .map(|direction| Ray::new(direction / -128.0 * far, direction))
        .collect()
}

fn answers(accel: &dyn Accel, rays: &RaySet) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    accel.trace(rays, &mut hits);
    hits
}

fn same(a: &Option<Hit>, b: &Option<Hit>) -> bool {
    a.zip(*b).map_or(a.is_none() && b.is_none(), |(a, b)| a.same_bits(&b))
}

/// The rays, and again with ranges that end or begin at what is hit.
fn with_ends(rays: Vec<Ray>, accel: &dyn Accel) -> RaySet {
    let mut all = rays.clone();
    for (ray, hit) in rays.iter().zip(answers(accel, &RaySet::List(rays.clone()))) {
        if let Some(Hit { t, .. }) = hit {
            all.push(Ray { t_max: t, ..*ray });
            all.push(Ray { t_min: t, ..*ray });
            all.push(Ray { t_max: t.next_down(), ..*ray });
            all.push(Ray { t_min: t.next_up(), ..*ray });
        }
    }
    RaySet::List(all)
}

fn check(scene: &Scene, power: i32, count: u64, kernels: &[KernelId]) {
    let oracle = harness::check::oracle_of(scene);
    for kernel in kernels {
        let brute = Brute::new(*kernel).build(scene, &Workload::GENERAL).unwrap();
        let rays = with_ends(rays(power, count), brute.as_ref());
        let expected = answers(brute.as_ref(), &rays);
        if *kernel == KernelId::Exact {
            for (i, hit) in expected.iter().enumerate() {
                let (ray, truth) = (rays.ray(i), oracle.closest(&rays.ray(i)));
                let judged = classify(*hit, truth.as_ref()).verdict;
                assert_eq!(judged, Verdict::Agree, "2^{power} {ray:?}: {hit:?} {truth:?}");
            }
        }
        for entry in registry::entries().iter().filter(|e| e.traits.built_in) {
            let choice = registry::parse(&format!("{}:kernel={kernel}", entry.id)).unwrap();
            let built = choice.builder.build(scene, &Workload::GENERAL).unwrap();
            for (i, hit) in answers(built.as_ref(), &rays).iter().enumerate() {
                let (ray, expected) = (rays.ray(i), expected[i]);
                assert!(
                    same(hit, &expected),
                    "{} {kernel} 2^{power} {ray:?}: {hit:?} {expected:?}",
                    entry.id
                );
                assert!(same(&built.closest(&ray), &expected), "{} {kernel} 2^{power} {ray:?}", entry.id);
                assert_eq!(
                    built.occluded(&ray),
                    expected.is_some(),
                    "{} {kernel} 2^{power} {ray:?}",
                    entry.id
                );
            }
        }
    }
}

#[test]
fn a_ball_is_hit_from_as_far_as_is_promised() {
    let scene = load("bumps-1k");
    let reach = FAR.log2() as i32;
    for power in (0..reach).step_by(7).chain([48, 52, 56, reach - 1]) {
        check(&scene, power, 12, &[KernelId::Exact, KernelId::Watertight]);
    }
}

#[test]
fn the_scale_of_the_scene_makes_no_difference() {
    for scale in [-60, 40] {
        let scene = load(&format!("bumps-1k@scale={scale}"));
        for power in [10, 30, 52] {
            check(&scene, scale + power, 6, &[KernelId::Exact, KernelId::MollerTrumbore]);
        }
    }
}

/// Found by a fuzzer: the line meets the padded boxes of an object and of the whole scene in one point, and the scene lies so far
/// from the origin of coordinates that a point of the line near it is rounded.
#[test]
fn a_scene_that_is_only_touched_is_not_missed() {
    let near = Vec3::splat(8_388_606.0);
    let far = Vec3::splat(8_388_607.5);
    let positions = vec![near, far, Vec3 { z: near.z, ..far }, Vec3 { x: 8_388_608.0, ..far }];
    let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [3, 1, 2], [0, 0, 0]] };
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    let scene = Scene { id: "touched".into(), geometry: Geometry::Triangles(mesh), view };
    let origin = Vec3::new(34_368_126_976.0, -137_430_564_864.0, 103_087_603_712.0);
    let rays = RaySet::List(vec![Ray::new(origin, Vec3::new(-0.5, 2.0, -1.5))]);
    for kernel in KernelId::ALL {
        let expected = answers(Brute::new(kernel).build(&scene, &Workload::GENERAL).unwrap().as_ref(), &rays);
        for id in ["minmax", "sphere", "ssm", "ssm-list", "bmssm", "bmssm-dense"] {
            let choice = registry::parse(&format!("{id}:kernel={kernel}")).unwrap();
            let built = choice.builder.build(&scene, &Workload::GENERAL).unwrap();
            let hits = answers(built.as_ref(), &rays);
            assert!(same(&hits[0], &expected[0]), "{id}, {kernel}: {hits:?}; brute force: {expected:?}");
        }
    }
}
