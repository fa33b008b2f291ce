//! The reference methods against the reference.

use accel::testing::cloud;
use accel::{Builder, Workload};
use baselines::{Brute, MinMax, Sphere};
use primitives::KernelId;

#[test]
fn bounding_volumes_lose_nothing() {
    let (scene, rays) = cloud(500, 3000);
    for kernel in KernelId::ALL {
        let mut reference = vec![None; rays.len()];
        Brute::new(kernel).build(&scene, &Workload::GENERAL).unwrap().trace(&rays, &mut reference);
        assert!(reference.iter().flatten().count() > 500);
        for builder in [&MinMax { kernel } as &dyn Builder, &Sphere { kernel }] {
            let built = builder.build(&scene, &Workload::GENERAL).unwrap();
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
        builder.build(&scene, &Workload::GENERAL).unwrap().trace(&rays, &mut hits);
        assert!(hits.iter().all(Option::is_none));
    }
}
