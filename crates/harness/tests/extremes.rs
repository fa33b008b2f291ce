//! Every structure of the suite's own with every kernel on extreme scenes and rays: what brute
//! force answers with that kernel, and with the exact kernel what the oracle says.

use accel::{Accel, Builder, Geometry, Hit, RaySet, Scene, Workload};
use baselines::Brute;
use harness::check::oracle_of;
use harness::registry;
use oracle::{Verdict, classify};
use primitives::KernelId;
use scenes::SceneSpec;
use scenes::rays::{RaysId, RaysSpec, generate};

fn load(id: &str) -> Scene {
    scenes::load(&id.parse::<SceneSpec>().unwrap()).unwrap()
}

/// All ray sets that the scene has.
fn ray_sets(scene: &Scene, side: u32) -> Vec<(RaysId, RaySet)> {
    let tracer = Brute::new(KernelId::Exact).build(scene, &Workload::GENERAL).unwrap();
    let spec = |id| RaysSpec { id, rows: side, cols: side, seed: 3 };
    let all = RaysId::ALL.into_iter();
    all.filter_map(|id| Some((id, generate(scene, &spec(id), tracer.as_ref()).ok()?))).collect()
}

fn answers(accel: &dyn Accel, rays: &RaySet) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    accel.trace(rays, &mut hits);
    hits
}

fn same(a: &Option<Hit>, b: &Option<Hit>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_bits(b),
        (None, None) => true,
        _ => false,
    }
}

fn denormal(t: f64) -> bool {
    t != 0.0 && t.abs() < f64::from(f32::MIN_POSITIVE)
}

/// Rays compared, all structures counted together.
fn check(id: &str, side: u32) -> usize {
    let scene = load(id);
    assert!(matches!(scene.geometry, Geometry::Triangles(_)), "{id} has no triangles");
    let oracle = oracle_of(&scene);
    let sets = ray_sets(&scene, side);
    let mut compared = 0;
    for kernel in KernelId::ALL {
        let brute = Brute::new(kernel).build(&scene, &Workload::GENERAL).unwrap();
        let references: Vec<_> = sets.iter().map(|(_, rays)| answers(brute.as_ref(), rays)).collect();
        if kernel == KernelId::Exact {
            for ((set, rays), reference) in sets.iter().zip(&references) {
                for (i, hit) in reference.iter().enumerate() {
                    let ray = rays.ray(i);
                    let exact = oracle.closest(&ray);
                    // The hit-in-padded-bounds invariant gives t a slack relative to itself: where t is less than the least
                    // normal number, its rounding alone may exceed that.
                    if exact.as_ref().is_some_and(|(_, e)| denormal(e.t.to_f64())) {
                        continue;
                    }
                    let judgement = classify(*hit, exact.as_ref());
                    assert_eq!(judgement.verdict, Verdict::Agree, "{id} {set}: {ray:?} {hit:?} {exact:?}");
                    let rounded = exact.map(|(_, exact)| exact.t.to_f32());
                    assert_eq!(hit.map(|hit| hit.t), rounded, "{id} {set}: {ray:?}");
                }
            }
        }
        for entry in registry::entries().iter().filter(|e| e.traits.built_in && e.id != "brute") {
            let choice = registry::parse(&format!("{}:kernel={kernel}", entry.id)).unwrap();
            let general = choice.builder.build(&scene, &Workload::GENERAL).unwrap();
            for ((set, rays), reference) in sets.iter().zip(&references) {
                let raster;
                let accel = match rays {
                    RaySet::Raster(_) => {
                        raster = choice.builder.build(&scene, &Workload::of(rays)).unwrap();
                        &raster
                    }
                    RaySet::List(_) => &general,
                };
                for (i, (hit, expected)) in answers(accel.as_ref(), rays).iter().zip(reference).enumerate() {
                    let ray = rays.ray(i);
                    assert!(
                        same(hit, expected),
                        "{} {kernel} {id} {set}: {ray:?}: {hit:?}, brute force: {expected:?}",
                        entry.id
                    );
                }
                compared += rays.len();
            }
        }
    }
    compared
}

#[test]
fn scales_of_powers_of_two() {
    for exponent in [-100, -60, -31, 31, 60, 100] {
        assert!(check(&format!("bumps-1k@scale={exponent}"), 5) > 5000);
    }
}

#[test]
fn far_from_the_origin() {
    for distance in ["1e3", "1.5e5", "1e7"] {
        assert!(check(&format!("bumps-1k@offset={distance},{distance},{distance}"), 6) > 5000);
    }
}

#[test]
fn flat_equal_coplanar_and_degenerate_triangles() {
    for id in
        ["unit-one", "unit-equal", "unit-flat", "unit-coplanar", "unit-lines", "unit-points", "unit-empty"]
    {
        check(id, 6);
    }
}

#[test]
fn needles_ten_million_times_as_long_as_wide() {
    assert!(check("extreme-needles", 4) > 4000);
}

#[test]
fn extreme_sizes_of_units() {
    for id in ["unit-tiny", "unit-huge", "unit-far"] {
        check(id, 6);
    }
}

/// The exact kernel at a scale is itself at scale 1: t the same, for geometry and rays scale together.
#[test]
fn kernels_see_the_same_scene_at_every_scale() {
    let plain = load("bumps-1k");
    let sets = ray_sets(&plain, 8);
    for exponent in [-100, -50, 50, 100] {
        let scaled = load(&format!("bumps-1k@scale={exponent}"));
        let factor = 2f64.powi(exponent) as f32;
        for kernel in [KernelId::MollerTrumbore, KernelId::Watertight, KernelId::Exact] {
            let small = Brute::new(kernel).build(&plain, &Workload::GENERAL).unwrap();
            let large = Brute::new(kernel).build(&scaled, &Workload::GENERAL).unwrap();
            let mut hits = 0;
            for (set, rays) in sets.iter().filter(|(set, _)| !matches!(set, RaysId::Directions)) {
                for i in 0..rays.len() {
                    let ray = rays.ray(i);
                    let grown =
                        accel::Ray { origin: ray.origin * factor, direction: ray.direction * factor, ..ray };
                    let (a, b) = (small.closest(&ray), large.closest(&grown));
                    assert!(same(&a, &b), "{kernel} {set} 2^{exponent}: {ray:?}: {a:?} {b:?}");
                    hits += usize::from(a.is_some());
                }
            }
            assert!(hits > 300, "{kernel}: only {hits} hits");
        }
    }
}
