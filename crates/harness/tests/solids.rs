//! Every structure equals brute force on solids of every kind, apart and mixed.

use accel::testing::{KINDS, rays, solids};
use accel::{Accel, Builder, Hit, Projection, Raster, RaySet, Scene, Vec3, Workload};
use baselines::Brute;
use harness::registry;
use primitives::KernelId;

fn raster() -> Raster {
    Raster {
        projection: Projection::Perspective,
        rows: 24,
        cols: 32,
        origin: Vec3::new(0.1, 0.2, 4.0),
        forward: Vec3::new(-0.32, -0.24, -1.0),
        right: Vec3::X * 0.02,
        down: Vec3::Y * 0.02,
    }
}

fn answers(structure: &dyn Accel, rays: &RaySet) -> (Vec<Option<Hit>>, Vec<bool>) {
    let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
    structure.trace(rays, &mut hits);
    structure.trace_occluded(rays, &mut occluded);
    (hits, occluded)
}

/// Each built-in structure with each of its variants, against brute force.
fn assert_equal(scene: &Scene, what: &str) {
    let (list, raster) = (RaySet::List(rays(3, 600)), raster());
    let mut hit = 0;
    for (rays, need) in [(list, Workload::GENERAL), (RaySet::Raster(raster), Workload::raster(raster))] {
        for spec in registry::with_variants(|entry| entry.traits.built_in) {
            let choice = registry::choose(&spec).unwrap();
            let Ok(structure) = choice.builder.build(scene, &need) else { continue };
            let kernel = choice.built_in_kernel().unwrap_or(KernelId::MollerTrumbore);
            let brute = Brute::new(kernel).build(scene, &need).unwrap();
            let (expected, found) = (answers(&*brute, &rays), answers(&*structure, &rays));
            hit += expected.0.iter().flatten().count();
            for (i, (a, b)) in expected.0.iter().zip(&found.0).enumerate() {
                let same = match (a, b) {
                    (Some(a), Some(b)) => a.same_bits(b),
                    (a, b) => a.is_none() && b.is_none(),
                };
                assert!(same, "{what}, {spec}: {:?} hits {b:?}, not {a:?}", rays.ray(i));
            }
            assert_eq!(expected.1, found.1, "{what}, {spec}: occlusion");
        }
    }
    assert!(hit > 1000, "{what}: {hit} hits");
}

#[test]
fn each_kind_is_found_by_each_structure() {
    for kind in KINDS {
        assert_equal(&solids(5, &[kind], 100, 0.2), kind);
    }
}

#[test]
fn mixed_kinds_are_found_by_each_structure() {
    assert_equal(&solids(7, &KINDS, 400, 0.1), "mixed");
    assert_equal(&solids(8, &["sphere", "cylinder"], 300, 0.1), "balls and sticks");
}
