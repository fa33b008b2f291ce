//! `bmssm-dense` against brute force: identical hits, whatever the scene, the rays and the settings.

use accel::{
    Aabb, Accel, BuildError, Builder, Geometry, Group, Hit, Mesh, Projection, Raster, Ray, RaySet, Scene,
    Vec3, View, Workload,
};
use baselines::Brute;
use bmssm::suite::dense::{Axis, BmssmDense};
use lanes::Level;
use primitives::KernelId;
use proptest::prelude::*;

const VIEW: View = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };

fn scene(geometry: Geometry) -> Scene {
    Scene { id: "test".into(), geometry, view: VIEW }
}

fn triangles(corners: &[[Vec3; 3]]) -> Scene {
    scene(Geometry::Triangles(Mesh {
        positions: corners.iter().flatten().copied().collect(),
        triangles: (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    }))
}

fn builder(settings: &str) -> BmssmDense {
    let mut builder = BmssmDense::default();
    for (name, value) in settings.split_whitespace().map(|pair| pair.split_once('=').unwrap()) {
        builder.set(name, value).unwrap();
    }
    builder
}

fn hits(accel: &dyn Accel, rays: &RaySet) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    accel.trace(rays, &mut hits);
    hits
}

/// Traces in every way and holds all answers to brute force; returns the number of hits.
fn compare(scene: &Scene, rays: &RaySet, settings: &str) -> usize {
    let builder = builder(settings);
    let reference =
        hits(&*Brute::new(builder.settings.kernel).build(scene, &Workload::of(rays)).unwrap(), rays);
    let both = Workload { general: true, ..Workload::of(rays) };
    for workload in [Workload::of(rays), both, Workload::GENERAL] {
        let built = builder.build(scene, &workload).unwrap();
        for (index, (found, wanted)) in hits(&*built, rays).iter().zip(&reference).enumerate() {
            let same = match (found, wanted) {
                (Some(a), Some(b)) => a.same_bits(b),
                (a, b) => a.is_none() && b.is_none(),
            };
            assert!(same, "{settings} {workload:?}: {:?} gives {found:?}, not {wanted:?}", rays.ray(index));
        }
        let mut occluded = vec![false; rays.len()];
        built.trace_occluded(rays, &mut occluded);
        assert!(
            occluded.iter().zip(&reference).all(|(o, hit)| *o == hit.is_some()),
            "{settings} {workload:?}"
        );
        if workload.general {
            for (index, wanted) in reference.iter().enumerate().step_by(7) {
                assert_eq!(built.closest(&rays.ray(index)), *wanted);
                assert_eq!(built.occluded(&rays.ray(index)), wanted.is_some());
            }
        }
        let counters = built.count(rays, false).unwrap();
        assert!(counters.tests <= counters.candidates && counters.tests >= hits_of(&reference) as u64);
    }
    hits_of(&reference)
}

fn hits_of(hits: &[Option<Hit>]) -> usize {
    hits.iter().flatten().count()
}

/// Values in slice planes of a unit scene, and others.
fn coordinate(range: f32) -> impl Strategy<Value = f32> {
    prop_oneof![3 => -range..range, 1 => prop::sample::select(vec![-1.0f32, -0.5, -0.0, 0.0, 0.25, 0.5, 1.0])]
}

fn point(range: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(coordinate(range)).prop_map(Vec3::from_array)
}

fn direction() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        point(1.0),
        prop::array::uniform3(prop::sample::select(vec![-1.0f32, -0.0, 0.0, 1.0])).prop_map(Vec3::from_array),
    ]
    .prop_filter("zero", |d| *d != Vec3::ZERO)
}

fn ray() -> impl Strategy<Value = Ray> {
    let range = prop_oneof![3 => Just((0.0, f32::INFINITY)), 1 => Just((0.3, 1.1)), 1 => Just((-2.0, 0.5))];
    (prop_oneof![point(1.0), point(3.0)], direction(), range)
        .prop_map(|(origin, direction, (t_min, t_max))| Ray { origin, direction, t_min, t_max })
}

/// Small and large triangles and boxes within about a unit, sometimes flat, sometimes none or one.
fn geometry() -> impl Strategy<Value = Scene> {
    let objects = prop_oneof![
        Just(vec![]),
        prop::collection::vec((point(1.0), [point(1.0), point(1.0), point(1.0)]), 1..2),
        prop::collection::vec((point(1.0), [point(1.0), point(1.0), point(1.0)]), 2..200),
    ];
    (
        objects,
        prop::sample::select(vec![0.1f32, 0.3, 1.5]),
        any::<bool>(),
        prop::sample::select(vec![1.0f32, 0.0]),
    )
        .prop_map(|(objects, size, boxes, depth)| {
            let flat = Vec3::new(1.0, 1.0, depth);
            let corners: Vec<[Vec3; 3]> =
                objects.iter().map(|(at, offsets)| offsets.map(|o| (*at + o * size) * flat)).collect();
            match boxes {
                true => scene(Geometry::Boxes(corners.iter().map(|c| Aabb::of_points(*c)).collect())),
                false => triangles(&corners),
            }
        })
}

fn raster() -> impl Strategy<Value = Raster> {
    let frames = prop_oneof![
        Just([Vec3::NEG_Z, Vec3::X * 0.125, Vec3::NEG_Y * 0.125]),
        Just([Vec3::X, Vec3::new(-0.0, 0.125, 0.0), Vec3::new(0.0, -0.0, 0.125)]),
        [point(1.0), point(0.2), point(0.2)],
    ];
    // From far away, and from inside the scene.
    let origins = prop_oneof![Just(Vec3::Z * 2.0), point(1.0), point(4.0), Just(Vec3::ZERO)];
    (frames, origins, any::<bool>()).prop_filter_map("zero direction", |([forward, right, down], at, eye)| {
        let (rows, cols) = (9, 14);
        let centred = right * (-0.5 * cols as f32) + down * (-0.5 * rows as f32);
        let raster = match eye {
            true => Raster {
                projection: Projection::Perspective,
                rows,
                cols,
                origin: at,
                forward: forward + centred,
                right,
                down,
            },
            false => Raster {
                projection: Projection::Parallel,
                rows,
                cols,
                origin: at + centred,
                forward,
                right,
                down,
            },
        };
        let set = RaySet::Raster(raster);
        (0..set.len()).all(|i| set.ray(i).validate().is_ok()).then_some(raster)
    })
}

fn settings() -> impl Strategy<Value = String> {
    (
        prop::sample::select(vec!["1", "4", "3x1x7", "16", "40x9x2", "auto"]),
        prop::sample::select(vec!["appendix", "words"]),
        prop::array::uniform2(prop::sample::select(vec!["on", "off"])),
        prop::sample::select(KernelId::ALL.map(KernelId::id).to_vec()),
        prop::sample::select(Level::here().map(Level::id).collect::<Vec<_>>()),
    )
        .prop_map(|(n, walk, [mailbox, levels], kernel, simd)| {
            format!(
                "resolution={n} loop={walk} mailbox={mailbox} levels={levels} kernel={kernel} simd={simd}"
            )
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn lists_equal_brute_force(
        scene in geometry(), rays in prop::collection::vec(ray(), 1..80), settings in settings(),
    ) {
        compare(&scene, &RaySet::List(rays), &settings);
    }

    #[test]
    fn rasters_equal_brute_force(scene in geometry(), raster in raster(), settings in settings()) {
        compare(&scene, &RaySet::Raster(raster), &settings);
    }
}

/// A 4 × 4 × 4 array of triangles, two in each unit cell's middle.
fn lattice() -> Scene {
    let corners: Vec<[Vec3; 3]> = (0..128)
        .map(|i| Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32 * 0.5))
        .map(|at| [at, at + Vec3::new(0.7, 0.1, 0.1), at + Vec3::new(0.1, 0.7, 0.2)])
        .collect();
    triangles(&corners)
}

#[test]
fn a_lattice_is_seen_from_outside_and_inside() {
    let forward = Vec3::new(0.01, 0.02, 1.0);
    let parallel = Raster {
        projection: Projection::Parallel,
        rows: 40,
        cols: 40,
        origin: Vec3::new(-0.1, -0.1, -3.0),
        forward,
        right: Vec3::X * 0.1,
        down: Vec3::Y * 0.1,
    };
    let inside = Raster {
        projection: Projection::Perspective,
        origin: Vec3::splat(1.6),
        forward: Vec3::new(-1.0, -1.0, 0.9),
        right: Vec3::X * 0.05,
        down: Vec3::Y * 0.05,
        ..parallel
    };
    for settings in ["loop=appendix", "loop=words resolution=8 mailbox=on"] {
        assert!(compare(&lattice(), &RaySet::Raster(parallel), settings) > 400);
        assert!(compare(&lattice(), &RaySet::Raster(inside), settings) > 100);
    }
}

/// §5: M_BMSSM = 3·N·p bits; §3: (n + m)·p bits. No T maps for primary rays, no R and S of an
/// image without one.
#[test]
fn the_footprint_is_the_maps_that_the_need_names() {
    let scene = lattice();
    let raster = Raster {
        projection: Projection::Parallel,
        rows: 24,
        cols: 32,
        origin: Vec3::ZERO,
        forward: Vec3::Z,
        right: Vec3::X,
        down: Vec3::Y,
    };
    let structure = |workload: &Workload, settings: &str| {
        builder(settings).build(&scene, workload).unwrap().footprint().bytes(Group::Structure)
    };
    assert_eq!(structure(&Workload::GENERAL, "resolution=16") * 8, 3 * 16 * 128);
    assert_eq!(structure(&Workload::GENERAL, "resolution=4x8x2") * 8, (4 + 8 + 2) * 128);
    assert_eq!(structure(&Workload::raster(raster), "resolution=16") * 8, (24 + 32) * 128);
    let both = Workload { raster: Some(raster), general: true };
    assert_eq!(structure(&both, "resolution=16") * 8, (24 + 32 + 3 * 16) * 128);
    assert_eq!(Axis::bytes_of(16, 128) * 8, 16 * 128);
}

#[test]
fn impossible_settings_are_errors_before_anything_is_allocated() {
    let scene = lattice();
    let mut dense = builder("memory=1000");
    dense.settings.resolution = bmssm::suite::dense::Resolution::Same(16_384);
    let error = dense.build(&scene, &Workload::GENERAL).err().unwrap();
    let bytes = 3 * 16_384 * 16;
    assert_eq!(error, BuildError::TooLarge { structure: "bmssm-dense".into(), bytes, limit: 1000 });
    dense.settings.resolution = bmssm::suite::dense::Resolution::Same(0);
    assert!(matches!(dense.build(&scene, &Workload::GENERAL), Err(BuildError::Setting { .. })));
    assert!(matches!(dense.set("resolution", "0"), Err(BuildError::Setting { .. })));
}

#[test]
fn the_mailbox_saves_tests_and_the_plan_tells_what_was_built() {
    let rays = RaySet::List(
        (0..50).map(|i| Ray::new(Vec3::splat(-1.0), Vec3::new(1.0, 0.9 + i as f32 * 0.01, 0.8))).collect(),
    );
    let scene = lattice();
    let tests = |settings: &str| {
        let built = builder(settings).build(&scene, &Workload::GENERAL).unwrap();
        assert_eq!(built.plan(), "16 × 16 × 16 slices");
        built.count(&rays, false).unwrap().tests
    };
    assert!(tests("resolution=16 mailbox=on") < tests("resolution=16 mailbox=off"));
}

#[test]
fn maps_above_maps_pass_over_empty_words_and_no_candidate() {
    let scene = lattice();
    let rays = RaySet::List(
        (0..50).map(|i| Ray::new(Vec3::splat(-1.0), Vec3::new(1.0, 0.9 + i as f32 * 0.01, 0.8))).collect(),
    );
    let count = |settings: &str| {
        let built = builder(settings).build(&scene, &Workload::GENERAL).unwrap();
        (built.plan(), built.count(&rays, false).unwrap())
    };
    let ((_, flat), (plan, levels)) = (count("resolution=16"), count("resolution=16 levels=on"));
    assert!(plan.contains("levels of maps above"), "{plan}");
    assert_eq!((levels.candidates, levels.tests, levels.cells), (flat.candidates, flat.tests, flat.cells));
    assert!(levels.words < flat.words, "{} {}", levels.words, flat.words);
}
