//! A planted fault of each kind is counted as that kind and no other.

use crate::{Counts, Judge, Kind, Tolerance};
use accel::{Geometry, Hit, Mesh, Ray, RaySet, Scene, Vec3, View};
use proptest::prelude::*;

/// A wall at z = 0 of two triangles, one at z = −1 behind it, and twins of the front ones in the same place.
fn scene(scale: f32) -> Scene {
    let square = |z: f32| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, z) * scale)
    };
    let mesh = Mesh {
        positions: [square(0.0), square(-1.0)].concat(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [0, 1, 2], [0, 2, 3]],
    };
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 40.0 };
    Scene { id: "walls".into(), geometry: Geometry::Triangles(mesh), view }
}

/// Through the lower right half: triangle 0.
fn ray(scale: f32) -> Ray {
    Ray::new(Vec3::new(0.25, -0.5, 1.0) * scale, Vec3::NEG_Z)
}

/// The weights of the true point in triangle 0 and 4.
const WEIGHTS: (f32, f32) = (0.375, 0.25);

fn kinds(scale: f32, ray: Ray, reported: Option<Hit>) -> (Option<Kind>, Counts) {
    let scene = scene(scale);
    let judge = Judge::new(&scene, Tolerance::VISIBLE);
    let rays = RaySet::List(vec![ray]);
    let truth = judge.truth(&rays, &mut |_| {});
    let tally = judge.judge_all(&rays, &truth, &[reported]);
    (judge.judge(&ray, reported, truth.0[0].as_ref()).kind, tally.counts)
}

#[test]
fn planted_faults_are_of_their_kind_and_no_other() {
    for scale in [1e-30f32, 1.0, 1e30] {
        let at = |t: f32, object: u32| Some(Hit { t: t * scale, object, u: WEIGHTS.0, v: WEIGHTS.1 });
        let away = Ray { direction: Vec3::Z, ..ray(scale) };
        let cases = [
            (ray(scale), at(1.0, 0), None),
            (ray(scale), at(1.000_01, 0), None),
            (ray(scale), None, Some(Kind::Hole)),
            (ray(scale), at(2.0, 2), Some(Kind::Hole)),
            (ray(scale), at(0.5, 2), Some(Kind::Phantom)),
            (away, at(1.0, 0), Some(Kind::Phantom)),
            (ray(scale), at(1.1, 0), Some(Kind::Displaced)),
            (ray(scale), at(0.9, 4), Some(Kind::Displaced)),
            (ray(scale), at(f32::NAN, 0), Some(Kind::Displaced)),
            (ray(scale), at(1.0, 2), Some(Kind::Swapped)),
            (ray(scale), at(1.0, 99), Some(Kind::Swapped)),
            (ray(scale), at(1.0, 4), Some(Kind::Tie)),
            (away, None, None),
        ];
        for (ray, reported, expected) in cases {
            let (kind, counts) = kinds(scale, ray, reported);
            assert_eq!(kind, expected, "{reported:?} at scale {scale}");
            for kind in Kind::ALL {
                assert_eq!(counts.of(kind), u64::from(Some(kind) == expected), "{kind:?}: {reported:?}");
            }
        }
    }
}

#[test]
fn errors_in_space_are_in_extents_and_ulps_only_of_ordinary_t() {
    let scene = scene(10.0);
    let judge = Judge::new(&scene, Tolerance::VISIBLE);
    let (u, v) = WEIGHTS;
    let rays = RaySet::List(vec![ray(10.0), Ray { origin: Vec3::new(2.5, -5.0, 1e-6), ..ray(10.0) }]);
    let truth = judge.truth(&rays, &mut |_| {});
    let hits =
        [Some(Hit { t: 10.0f32.next_up(), object: 0, u: u + 0.5, v }), Some(Hit { t: 0.0, object: 0, u, v })];
    let mut tally = judge.judge_all(&rays, &truth, &hits);
    assert_eq!(tally.counts, Counts { rays: 2, ..Counts::default() });
    let errors = tally.errors();
    // Half of the first edge, which is as long as the scene is wide.
    assert!((errors.point.largest - 0.5).abs() < 1e-12, "{errors:?}");
    assert_eq!((errors.hits, errors.t_ulps.median, errors.t_ulps.largest), (2, 1.0, 1.0), "{errors:?}");
    assert!(errors.along.largest < 1e-6);
}

#[test]
fn a_t_as_near_as_any_f32_is_in_its_place() {
    let far = Ray::new(Vec3::new(0.25, -0.5, 1e12), Vec3::new(0.0, 0.0, -3.0));
    let (kind, _) =
        kinds(1.0, far, Some(Hit { t: (1e12f32 as f64 / 3.0) as f32, object: 0, u: 0.0, v: 0.0 }));
    assert_eq!(kind, None);
}

proptest! {
    /// Doubling every triangle adds no visible error, whatever is reported and of which twin.
    #[test]
    fn doubling_changes_nothing_that_shows(x in -1.2f32..1.2, y in -1.2f32..1.2, t in prop::option::of(0f32..3.0), object in 0u32..4, twin: bool) {
        let Geometry::Triangles(mesh) = scene(1.0).geometry else { unreachable!() };
        let half = Mesh { triangles: mesh.triangles[..4].to_vec(), ..mesh };
        let with = |triangles: Vec<[u32; 3]>| Scene { geometry: Geometry::Triangles(Mesh { triangles, ..half.clone() }), ..scene(1.0) };
        let single = with(half.triangles.clone());
        let double = with([half.triangles.clone(), half.triangles.clone()].concat());
        let ray = Ray::new(Vec3::new(x, y, 1.0), Vec3::NEG_Z);
        let kind = |scene: &Scene, object| {
            let judge = Judge::new(scene, Tolerance::VISIBLE);
            let truth = judge.truth(&RaySet::List(vec![ray]), &mut |_| {});
            let hit = t.map(|t| Hit { t, object, u: 0.0, v: 0.0 });
            judge.judge(&ray, hit, truth.0[0].as_ref()).kind.filter(|kind| Kind::VISIBLE.contains(kind))
        };
        prop_assert_eq!(kind(&single, object), kind(&double, if twin { object + 4 } else { object }));
    }
}
