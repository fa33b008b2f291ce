use super::*;
use accel::{Geometry, Group, Projection, Raster, Ray, RaySet, Vec3, testing};
use baselines::Brute;
use primitives::KernelId;

fn scene() -> Scene {
    testing::scene(Geometry::Triangles(testing::soup(11, 3000, 0.1)))
}

fn image() -> Raster {
    Raster {
        projection: Projection::Parallel,
        rows: 50,
        cols: 70,
        origin: Vec3::new(-1.1, 1.1, 3.0),
        forward: Vec3::NEG_Z,
        right: Vec3::X * (2.2 / 70.0),
        down: Vec3::NEG_Y * (2.2 / 50.0),
    }
}

fn list() -> RaySet {
    let origin = |i: i32| Vec3::new(i as f32 * 0.01 - 1.0, 0.1, -1.5);
    RaySet::List((0..200).map(|i| Ray::new(origin(i), Vec3::new(0.1, -0.05, 1.0))).collect())
}

#[test]
fn every_need_is_served_with_what_it_names() {
    let scene = scene();
    let image = image();
    let brute = Brute::new(KernelId::MollerTrumbore).build(&scene, &Workload::GENERAL).unwrap();
    let both = Workload { raster: Some(image), general: true };
    for workload in [Workload::raster(image), Workload::GENERAL, both] {
        let built = Bmssm::default().build(&scene, &workload).unwrap();
        let mut sets = Vec::new();
        sets.extend(workload.raster.map(RaySet::Raster));
        sets.extend(workload.general.then(list));
        for set in &sets {
            let (mut hits, mut reference) = (vec![None; set.len()], vec![None; set.len()]);
            built.trace(set, &mut hits);
            brute.trace(set, &mut reference);
            assert_eq!(hits, reference);
            assert!(reference.iter().flatten().count() > 50);
            let mut occluded = vec![false; set.len()];
            built.trace_occluded(set, &mut occluded);
            assert!(occluded.iter().zip(&reference).all(|(o, hit)| *o == hit.is_some()));
            let ray = set.ray(set.len() / 2);
            assert_eq!(built.closest(&ray), brute.closest(&ray));
            assert!(built.count(set, false).unwrap().tests > 0);
        }
        let names: Vec<_> = built.footprint().parts.iter().map(|part| part.name).collect();
        assert_eq!(names.contains(&"tree"), workload.general, "{names:?}");
        assert_eq!(built.plan().contains("image maps"), workload.raster.is_some());
    }
}

#[test]
fn the_plan_bounds_what_is_built() {
    let scene = scene();
    for workload in [Workload::raster(image()), Workload::GENERAL] {
        let bmssm = Bmssm::default();
        let plan = Plan::new(&bmssm.settings, scene.geometry.len(), &workload, u128::MAX, |slots| {
            64 * slots as u128
        });
        let footprint = bmssm.build(&scene, &workload).unwrap().footprint();
        assert!(footprint.bytes(Group::Structure) > 0);
        assert!(footprint.total() as u128 <= plan.bytes + 4096, "{footprint:?} {}", plan.bytes);
        let mut tight = bmssm;
        tight.set("memory", "1000").unwrap();
        assert!(matches!(tight.build(&scene, &workload), Err(BuildError::TooLarge { limit: 1000, .. })));
    }
}

#[test]
fn every_setting_is_read_as_it_is_written() {
    let text = "kernel=watertight simd=portable exact_split=512 geometry=scene tile=4 depth_bits=1 large=9 memory=123";
    let mut settings = Settings::default();
    for (name, value) in text.split(' ').map(|pair| pair.split_once('=').unwrap()) {
        settings.set(name, value).unwrap();
    }
    assert_eq!(settings.to_string(), text);
    for (name, _) in Settings::NAMES {
        assert!(Settings::default().set(name, "?").unwrap_err().contains("'?'"), "{name}");
    }
    assert!(Bmssm::default().set("colour", "red").is_err());
}
