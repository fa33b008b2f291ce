use super::*;
use crate::fast;
use accel::testing::{Numbers, scene};
use accel::{Aabb, Accel, Builder, Cancel, Geometry, Hit, Mesh, Projection, RaySet, Scene, Vec3, Workload};
use baselines::Brute;
use lanes::{PackedObjects, Simd, Task};
use primitives::WithObjects;

fn point(random: &mut Numbers, range: f32) -> Vec3 {
    random.vec3() * (2.0 * range) - range
}

fn mesh(corners: impl IntoIterator<Item = [Vec3; 3]>) -> Scene {
    let positions: Vec<Vec3> = corners.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    scene(Geometry::Triangles(Mesh { positions, triangles }))
}

/// `count` triangles with edges of about `size` in the cube of half-width 1, then scaled and moved.
fn soup(count: usize, size: f32, scale: f32, offset: Vec3) -> Scene {
    let mut random = Numbers(count as u64);
    mesh((0..count).map(|_| {
        let middle = point(&mut random, 1.0);
        [0; 3].map(|_| (middle + point(&mut random, size)) * scale + offset)
    }))
}

/// Few large, many small, doubles and needles, degenerate ones.
fn mixed() -> Scene {
    let mut random = Numbers(5);
    let mut corners: Vec<[Vec3; 3]> = (0..600)
        .map(|i| {
            let size = [0.02, 0.3, 2.0][usize::from(i % 8 == 0) + usize::from(i % 40 == 0)];
            let middle = point(&mut random, 1.0);
            [0; 3].map(|_| middle + point(&mut random, size))
        })
        .collect();
    for i in 0..60 {
        let [a, b, _] = corners[i];
        corners.push(corners[i]);
        corners.push([a, a, b]);
        corners.push([a, a, a]);
        corners.push([a, b, b + (b - a) * 1e-6]);
    }
    mesh(corners)
}

/// Looks from `eye` at `target`; the image is about 2·`half` wide at the target.
fn look(projection: Projection, [rows, cols]: [u32; 2], eye: Vec3, target: Vec3, half: f32) -> Raster {
    let forward = target - eye;
    let side = forward.cross(Vec3::new(0.1, 0.2, 1.0)).normalize();
    let up = forward.cross(side).normalize();
    let (right, down) = (side * (2.0 * half / cols as f32), up * (2.0 * half / rows as f32));
    let corner = right * (-0.5 * cols as f32) + down * (-0.5 * rows as f32);
    match projection {
        Projection::Parallel => Raster { projection, rows, cols, origin: eye + corner, forward, right, down },
        Projection::Perspective => {
            Raster { projection, rows, cols, origin: eye, forward: forward + corner, right, down }
        }
    }
}

fn same(a: &Option<Hit>, b: &Option<Hit>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_bits(b),
        (None, None) => true,
        _ => false,
    }
}

/// Compares with brute force bit for bit; returns the number of hits.
fn check(scene: &Scene, raster: &Raster, settings: Settings) -> usize {
    let rays = RaySet::Raster(*raster);
    let workload = Workload::raster(*raster);
    let mut expected = vec![None; rays.len()];
    let brute = Brute::new(settings.kernel).build(scene, &workload).expect("brute force");
    brute.trace(&rays, &mut expected);
    let Settings { kernel, simd, tile, depth_bits, large } = settings;
    let settings = fast::Settings { kernel, simd, tile, depth_bits, large, ..fast::Settings::default() };
    let built = fast::Bmssm { settings }.build(scene, &workload).expect("a raster is served");
    let mut hits = vec![Some(Hit { t: -1.0, object: 7, u: 0.0, v: 0.0 }); rays.len()];
    built.trace(&rays, &mut hits);
    for (i, (hit, expected)) in hits.iter().zip(&expected).enumerate() {
        assert!(same(hit, expected), "{settings:?} ray {i} of {raster:?}: {hit:?}, not {expected:?}");
    }
    for i in (0..rays.len()).step_by(37) {
        let (hit, expected) = (built.closest(&rays.ray(i)), &expected[i]);
        assert!(same(&hit, expected), "{settings:?} single ray {i} of {raster:?}: {hit:?}, not {expected:?}");
    }
    expected.iter().flatten().count()
}

fn threads<T: Send>(count: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads").install(run)
}

const BOTH: [Projection; 2] = [Projection::Parallel, Projection::Perspective];

#[test]
fn equals_brute_force_at_every_level_and_kernel() {
    let eye = Vec3::new(1.5, -2.2, 1.4);
    let scenes = [soup(900, 0.08, 1.0, Vec3::ZERO), soup(300, 0.5, 1.0, Vec3::ZERO), mixed()];
    for scene in &scenes {
        for projection in BOTH {
            let raster = look(projection, [62, 75], eye, Vec3::ZERO, 1.6);
            for kernel in KernelId::ALL {
                for simd in Level::here() {
                    let hits = check(scene, &raster, Settings { kernel, simd, ..Settings::default() });
                    assert!(hits > 500, "{hits} hits");
                }
            }
        }
    }
}

#[test]
fn any_size_of_image_and_tile() {
    let scene = mixed();
    let eye = Vec3::new(-1.5, 2.0, 1.0);
    for size in [[1, 1], [1, 50], [3, 4], [5, 9], [33, 31], [128, 4]] {
        for projection in BOTH {
            for (tile, depth_bits, large) in [(8, 2, 8), (1, 0, 1), (3, 12, 1000)] {
                let raster = look(projection, size, eye, Vec3::ZERO, 1.2);
                check(&scene, &raster, Settings { tile, depth_bits, large, ..Settings::default() });
            }
        }
    }
    let none = look(Projection::Parallel, [1, 1], eye, Vec3::ZERO, 1.0);
    check(&scene, &Raster { rows: 0, ..none }, Settings::default());
}

#[test]
fn eyes_inside_and_images_beside_the_scene() {
    let scenes = [mixed(), soup(500, 0.3, 1.0, Vec3::ZERO)];
    let mut random = Numbers(3);
    for scene in &scenes {
        for projection in BOTH {
            for _ in 0..6 {
                let (eye, target) = (point(&mut random, 0.9), point(&mut random, 1.0));
                let raster = look(projection, [40, 44], eye, target, random.unit() * 2.0 + 0.01);
                check(scene, &raster, Settings::default());
            }
            let away = look(projection, [16, 16], Vec3::splat(3.0), Vec3::splat(6.0), 1.0);
            assert_eq!(check(scene, &away, Settings::default()), 0);
        }
    }
}

#[test]
fn tiny_huge_and_far_scenes() {
    for (scale, offset) in [(1e-12, 0.0), (1e12, 0.0), (1.0, 1e4), (1e-3, 50.0)] {
        let offset = Vec3::new(offset, -offset, offset * 0.5);
        let scene = soup(400, 0.2, scale, offset);
        for projection in BOTH {
            let eye = Vec3::new(1.5, -2.2, 1.4) * scale + offset;
            let raster = look(projection, [45, 45], eye, offset, 1.2 * scale);
            assert!(check(&scene, &raster, Settings::default()) > 100);
        }
    }
}

#[test]
fn degenerate_rasters_lose_nothing() {
    let scene = mixed();
    for projection in BOTH {
        let raster = look(projection, [17, 18], Vec3::new(1.0, 2.0, 2.0), Vec3::ZERO, 1.0);
        for broken in [
            Raster { right: raster.down, ..raster },
            Raster { right: Vec3::ZERO, ..raster },
            Raster { down: raster.forward * 0.01, ..raster },
        ] {
            check(&scene, &broken, Settings::default());
        }
    }
}

#[test]
fn boxes_and_empty_scenes() {
    let mut random = Numbers(11);
    let boxes: Vec<Aabb> = (0..300)
        .map(|_| {
            let (a, b) = (point(&mut random, 1.0), point(&mut random, 0.1));
            Aabb::of_points([a, a + b])
        })
        .collect();
    let empty = mesh([]);
    for projection in BOTH {
        let raster = look(projection, [50, 50], Vec3::new(1.5, -2.2, 1.4), Vec3::ZERO, 1.5);
        for simd in Level::here() {
            let settings = Settings { simd, ..Settings::default() };
            assert!(check(&scene(Geometry::Boxes(boxes.clone())), &raster, settings) > 100);
            assert_eq!(check(&empty, &raster, settings), 0);
            assert_eq!(check(&scene(Geometry::Boxes(vec![])), &raster, settings), 0);
        }
        let boxes: Vec<Aabb> = boxes.clone();
        check(
            &scene(Geometry::Boxes(boxes)),
            &look(projection, [9, 9], Vec3::splat(0.1), Vec3::X, 1.0),
            Settings::default(),
        );
    }
}

#[test]
fn threads_make_no_difference() {
    let scene = soup(40_000, 0.01, 1.0, Vec3::ZERO);
    let raster = look(Projection::Perspective, [70, 66], Vec3::new(1.5, -2.2, 1.4), Vec3::ZERO, 1.5);
    for count in [1, 2] {
        threads(count, || check(&scene, &raster, Settings::default()));
    }
}

#[test]
fn only_what_can_be_seen_is_stored_and_counted() {
    struct Lanes;
    impl Task for Lanes {
        type Out = usize;
        fn run<S: Simd>(self, _: S) -> usize {
            S::LANES
        }
    }
    struct Seen(Raster, Level);
    impl<'s> WithObjects<'s> for Seen {
        type Out = ();
        fn objects<O: PackedObjects + 's>(self, objects: O) {
            let Self(raster, simd) = self;
            let settings = Settings { simd, ..Settings::default() };
            let maps = RasterMaps::build(objects, &raster, settings, Bytes::ANY, Cancel::NEVER).unwrap();
            let covered: u32 = maps.coverage().iter().map(|w| w.count_ones()).sum();
            assert_eq!(covered as usize, maps.shown());
            assert!(maps.shown() < objects.len() / 2, "{}", maps.plan());
            let counters = maps.count();
            // The 16 pixels of a cell are tested so many at a time.
            let times = (16 / simd.run(Lanes)) as u64;
            assert!(counters.tests > 0 && counters.tests <= times * counters.candidates, "{simd:?}");
            assert!(counters.cells > 0 && counters.words > counters.cells && counters.blocks > 0);
            let footprint = RasterMaps::footprint(&maps);
            let copy = footprint.bytes(accel::Group::GeometryCopy);
            assert!(copy <= 40 * maps.shown().next_multiple_of(64), "{copy}");
        }
    }
    let raster = look(Projection::Parallel, [64, 64], Vec3::new(1.5, -2.2, 1.4), Vec3::ZERO, 0.4);
    for simd in Level::here() {
        primitives::with_objects(
            &soup(3000, 0.05, 1.0, Vec3::ZERO),
            KernelId::MollerTrumbore,
            Seen(raster, simd),
        );
    }
}
