use super::*;
use accel::testing::{Numbers, scene};
use accel::{Aabb, Builder, Geometry, Mesh, RaySet, Vec3, Workload};
use baselines::Brute;
use lanes::{BLOCK, EMPTY_SLOT, PackedObjects};
use primitives::{KernelId, WithObjects};
use proptest::prelude::*;

/// Numbers from −1 to 1.
fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut numbers = Numbers(seed);
    move || numbers.signed()
}

/// Triangles of mixed size, a few of them huge, thin or without area.
fn triangles(seed: u64, count: u32, scale: f32, offset: Vec3) -> Geometry {
    let mut number = numbers(seed);
    let mut point = |size: f32| Vec3::new(number(), number(), number()) * size;
    let mut mesh = Mesh::default();
    for i in 0..count {
        let size = [0.05, 0.05, 0.05, 0.3, 0.0, 1.5][(i % 97).min(5) as usize];
        let center = point(1.0);
        let corners = [center, center + point(size), center + point(size) * Vec3::new(1.0, 1.0, 0.01)];
        mesh.positions.extend(corners.map(|corner| corner * scale + offset));
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    Geometry::Triangles(mesh)
}

/// Rays from in and around the scene, many along axes and with negative zeros.
fn rays(seed: u64, count: usize, scale: f32, offset: Vec3) -> Vec<Ray> {
    let mut number = numbers(seed ^ 0x5555);
    let mut point = |size: f32| Vec3::new(number(), number(), number()) * size;
    (0..count)
        .map(|i| {
            let origin = match i % 4 {
                0 => point(3.0),
                1 => Vec3::new(-2.0, 0.0, 0.25),
                2 => (point(1.0) * 4.0).round() / 4.0,
                _ => point(1.0),
            };
            let direction = match i % 5 {
                0 => Vec3::new(1.0, -0.0, 0.0),
                1 => Vec3::new(0.0, 1e-30, -1.0),
                2 => Vec3::new(-1.0, 1.0, -0.0),
                _ => point(1.0),
            };
            let t_max = if i % 7 == 0 { 0.8 } else { f32::INFINITY };
            Ray { t_max, ..Ray::new(origin * scale + offset, direction * scale) }
        })
        .collect()
}

/// Rays of neighbours in runs that share their end, their origin or their direction, or nothing, some of them without
/// extent on an axis, some of short or empty ranges.
fn bundles(seed: u64, count: usize) -> Vec<Ray> {
    let mut number = numbers(seed ^ 0x7777);
    let mut point = |size: f32| Vec3::new(number(), number(), number()) * size;
    let mut rays = Vec::new();
    while rays.len() < count {
        let run = 3 + rays.len() % 61;
        let (corner, across, down) = (point(1.5), point(0.02), point(0.02));
        let (end, aim) = (point(2.0), point(1.0));
        let axis = Vec3::AXES[run % 3] * if run % 2 == 0 { -1.0 } else { 1.0 };
        for i in 0..run {
            let place = corner + across * (i % 8) as f32 + down * (i / 8) as f32;
            let (origin, direction) = match run % 7 {
                0 | 1 => (place, end - place),
                2 => (end, place - end),
                3 => (place, aim),
                4 => (place, axis),
                5 => (Vec3::new(place.x, 0.25, place.z), Vec3::new(aim.x, -0.0, aim.z)),
                _ => (place, point(1.0)),
            };
            let (t_min, t_max) = match (run / 7 + i) % 5 {
                0 => (0.0, 1.0 - 1.0 / 1024.0),
                1 => (-0.5, 0.5),
                2 if i % 11 == 0 => (0.75, 0.25),
                _ => (0.0, f32::INFINITY),
            };
            rays.push(Ray { origin, direction, t_min, t_max });
        }
    }
    rays.retain(|ray| ray.validate().is_ok());
    rays
}

struct Differences<'a>(&'a [Ray], &'a [Option<Hit>], Level, usize);

impl<'s> WithObjects<'s> for Differences<'_> {
    type Out = usize;
    fn objects<O: PackedObjects + 's>(self, objects: O) -> usize {
        let Self(rays, reference, simd, exact_split) = self;
        let of = |storage| {
            let settings = Settings { simd, exact_split, storage };
            differences(&General::new(&objects, settings, Cancel::NEVER).unwrap(), rays, reference)
        };
        Storage::ALL.map(of).iter().sum()
    }
}

/// Rays answered otherwise than by brute force, in a list or one by one.
fn differences<O: PackedObjects>(maps: &General<O>, rays: &[Ray], reference: &[Option<Hit>]) -> usize {
    let (mut hits, mut single) = (vec![None; rays.len()], vec![None; rays.len()]);
    let (mut occluded, mut alone) = (vec![false; rays.len()], vec![false; rays.len()]);
    maps.closest(rays, &mut hits);
    maps.occluded(rays, &mut occluded);
    for (i, ray) in rays.iter().enumerate() {
        maps.closest(std::slice::from_ref(ray), &mut single[i..=i]);
        maps.occluded(std::slice::from_ref(ray), &mut alone[i..=i]);
    }
    let same = |i: &usize| {
        let bits = |hit: &Option<Hit>| match (hit, &reference[*i]) {
            (Some(a), Some(b)) => a.same_bits(b),
            (None, None) => true,
            _ => false,
        };
        let there = reference[*i].is_some();
        bits(&hits[*i]) && bits(&single[*i]) && occluded[*i] == there && alone[*i] == there
    };
    (0..rays.len()).filter(|i| !same(i)).count()
}

fn assert_no_differences(geometry: Geometry, rays: &[Ray]) -> usize {
    let scene = scene(geometry);
    let mut hits = 0;
    for kernel in KernelId::ALL {
        let brute = Brute::new(kernel).build(&scene, &Workload::GENERAL).unwrap();
        let mut reference = vec![None; rays.len()];
        brute.trace(&RaySet::List(rays.to_vec()), &mut reference);
        hits = reference.iter().flatten().count();
        for simd in Level::here() {
            for exact_split in [128, MAX_EXACT_SPLIT] {
                let differences = primitives::with_objects(
                    &scene,
                    kernel,
                    Differences(rays, &reference, simd, exact_split),
                );
                assert_eq!(differences, 0, "{kernel} {simd:?} {exact_split}");
            }
        }
    }
    hits
}

#[test]
fn nothing_is_lost_in_scenes_of_several_levels() {
    let hits = assert_no_differences(triangles(1, 9000, 1.0, Vec3::ZERO), &rays(1, 1500, 1.0, Vec3::ZERO));
    assert!(hits > 500);
}

#[test]
fn nothing_is_lost_where_rays_of_all_directions_share_lists() {
    let scene = scene(triangles(8, 140_000, 1.0, Vec3::ZERO));
    let rays = rays(8, 400, 1.0, Vec3::ZERO);
    let brute = Brute::new(KernelId::MollerTrumbore).build(&scene, &Workload::GENERAL).unwrap();
    let mut reference = vec![None; rays.len()];
    brute.trace(&RaySet::List(rays.clone()), &mut reference);
    for simd in Level::here() {
        let differences = Differences(&rays, &reference, simd, MAX_EXACT_SPLIT);
        assert_eq!(primitives::with_objects(&scene, KernelId::MollerTrumbore, differences), 0, "{simd:?}");
    }
}

#[test]
fn nothing_is_lost_at_any_scale_and_offset() {
    for (scale, offset) in [
        (2f32.powi(-60), Vec3::ZERO),
        (2f32.powi(60), Vec3::ZERO),
        (2.0, Vec3::new(148_376.0, 1234.0, -223_423.0)),
        (1.0, Vec3::splat(1e7)),
    ] {
        assert_no_differences(triangles(2, 700, scale, offset), &rays(2, 400, scale, offset));
    }
}

#[test]
fn flat_empty_and_single_scenes_are_served() {
    let flat = |geometry: Geometry| match geometry {
        Geometry::Triangles(mut mesh) => {
            mesh.positions.iter_mut().for_each(|p| p.y = 0.25);
            Geometry::Triangles(mesh)
        }
        other => other,
    };
    let rays = rays(3, 600, 1.0, Vec3::ZERO);
    assert!(assert_no_differences(flat(triangles(3, 500, 1.0, Vec3::ZERO)), &rays) > 50);
    assert_eq!(assert_no_differences(Geometry::Triangles(Mesh::default()), &rays), 0);
    assert_no_differences(triangles(4, 1, 1.0, Vec3::ZERO), &rays);
    let repeated = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]; 300] };
    assert_no_differences(Geometry::Triangles(repeated), &rays);
}

#[test]
fn boxes_are_objects_too() {
    let mut number = numbers(9);
    let mut boxes = Vec::new();
    for _ in 0..500 {
        let center = Vec3::new(number(), number(), number());
        boxes.push(Aabb { min: center - 0.05, max: center + 0.05 });
    }
    assert!(assert_no_differences(Geometry::Boxes(boxes), &rays(9, 800, 1.0, Vec3::ZERO)) > 100);
}

#[test]
fn the_tree_holds_every_object_once_and_full_blocks() {
    struct Slots;
    impl<'s> WithObjects<'s> for Slots {
        type Out = (Vec<u32>, usize);
        fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
            let maps = General::new(
                &objects,
                Settings { simd: Level::Portable, exact_split: MAX_EXACT_SPLIT, storage: Storage::Rows },
                Cancel::NEVER,
            )
            .unwrap();
            let slots = (0..maps.maps.len() * BLOCK).map(|slot| maps.objects.object(slot));
            (slots.filter(|object| *object != EMPTY_SLOT).collect(), maps.maps.len())
        }
    }
    let scene = scene(triangles(5, 20_000, 1.0, Vec3::ZERO));
    let (mut objects, blocks) = primitives::with_objects(&scene, KernelId::MollerTrumbore, Slots);
    objects.sort_unstable();
    assert!(objects.iter().copied().eq(0..20_000));
    assert!(blocks <= 20_000 / BLOCK + 20, "{blocks} blocks");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn small_scenes_lose_nothing(seed: u64, count in 1u32..400) {
        assert_no_differences(triangles(seed, count, 1.0, Vec3::ZERO), &rays(seed, 200, 1.0, Vec3::ZERO));
    }

    #[test]
    fn neighbours_taken_together_lose_nothing(seed: u64, count in 1u32..900) {
        assert_no_differences(triangles(seed, count, 1.0, Vec3::ZERO), &bundles(seed, 300));
    }
}

#[test]
fn boxes_let_fewer_candidates_pass() {
    struct Tests<'a>(&'a [Ray], Storage);
    impl<'s> WithObjects<'s> for Tests<'_> {
        type Out = u64;
        fn objects<O: PackedObjects + 's>(self, objects: O) -> u64 {
            let settings = Settings { simd: Level::Portable, exact_split: MAX_EXACT_SPLIT, storage: self.1 };
            General::new(&objects, settings, Cancel::NEVER).unwrap().count(self.0, false).tests
        }
    }
    let scene = scene(triangles(7, 5000, 1.0, Vec3::ZERO));
    for rays in [rays(7, 500, 1.0, Vec3::ZERO), bundles(7, 500)] {
        let tests =
            |storage| primitives::with_objects(&scene, KernelId::MollerTrumbore, Tests(&rays, storage));
        let (boxes, all) = (tests(Storage::Boxes), tests(Storage::Scene));
        assert!(boxes < all / 10 * 7, "{boxes} of {all}");
    }
}

#[test]
fn neighbours_are_taken_together() {
    struct Steps<'a>(&'a [Ray]);
    impl<'s> WithObjects<'s> for Steps<'_> {
        type Out = u64;
        fn objects<O: PackedObjects + 's>(self, objects: O) -> u64 {
            let settings =
                Settings { simd: Level::Portable, exact_split: MAX_EXACT_SPLIT, storage: Storage::Rows };
            General::new(&objects, settings, Cancel::NEVER).unwrap().count(self.0, true).blocks
        }
    }
    let scene = scene(triangles(6, 5000, 1.0, Vec3::ZERO));
    let light = Vec3::new(3.0, 2.0, 1.0);
    let from = |i: u32| Vec3::new(-2.0 + 0.001 * (i % 64) as f32, 0.001 * (i / 64) as f32, -1.0);
    let shadows: Vec<Ray> = (0..2048).map(|i| Ray::new(from(i), light - from(i))).collect();
    let single: Vec<Ray> = shadows.iter().step_by(37).copied().collect();
    let steps = |rays: &[Ray]| {
        let blocks = primitives::with_objects(&scene, KernelId::MollerTrumbore, Steps(rays));
        blocks as f64 / rays.len() as f64
    };
    let alone: f64 =
        single.iter().map(|ray| steps(std::slice::from_ref(ray))).sum::<f64>() / single.len() as f64;
    assert!(steps(&shadows) < alone / 4.0, "{} {alone}", steps(&shadows));
}
