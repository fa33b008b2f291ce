//! Rays that [`accel::Ray::validate`] turns down, given to the structures all the same: every walk ends, and
//! no triangle is hit.

use accel::{Accel, Ray, RaySet, Vec3, Workload};
use harness::registry;
use primitives::KernelId;
use scenes::SceneSpec;
use std::time::Duration;
use verify::patience;

fn unusable() -> Vec<Ray> {
    let inside = Vec3::splat(0.01);
    let mut rays = Vec::new();
    for direction in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::new(f32::NAN, 1.0, 0.0)] {
        rays.push(Ray::new(inside, direction));
        rays.push(Ray { t_max: 7.0, ..Ray::new(inside, direction) });
    }
    for origin in [Vec3::NAN, Vec3::INFINITY, Vec3::new(0.0, f32::NEG_INFINITY, f32::NAN)] {
        rays.push(Ray::new(origin, Vec3::X));
    }
    for (t_min, t_max) in [(f32::NAN, 1.0), (f32::INFINITY, f32::INFINITY), (0.0, f32::NAN)] {
        rays.push(Ray { t_min, t_max, ..Ray::new(inside, Vec3::new(1.0, 0.2, 0.1)) });
    }
    assert!(rays.iter().all(|ray| ray.validate().is_err()));
    rays
}

/// A walk without an end is a failure that says so, not a test without an end.
const PATIENCE: Duration = Duration::from_secs(120);

#[test]
fn every_walk_ends_and_no_triangle_is_hit() {
    patience::within(PATIENCE, walk).expect("a walk does not end");
}

fn walk() {
    let scene = scenes::load(&"small-1k".parse::<SceneSpec>().unwrap()).unwrap();
    let rays = unusable();
    let list = RaySet::List(rays.clone());
    let mut tried = 0;
    for spec in registry::with_variants(|entry| entry.traits.built_in) {
        let built = registry::choose(&spec).unwrap().builder.build(&scene, &Workload::GENERAL).unwrap();
        let mut hits = vec![None; rays.len()];
        built.trace(&list, &mut hits);
        let mut occluded = vec![false; rays.len()];
        built.trace_occluded(&list, &mut occluded);
        for (i, ray) in rays.iter().enumerate() {
            let one = Accel::closest(built.as_ref(), ray);
            tried += 1;
            // A ray that begins in a box has hit it, whatever its direction.
            if spec.get("kernel") == Some(KernelId::BoundingBox.id()) {
                continue;
            }
            assert_eq!((hits[i], one, occluded[i]), (None, None, false), "{spec} on {ray:?}");
            assert!(!built.occluded(ray), "{spec} on {ray:?}");
        }
    }
    assert!(tried > 50);
}
