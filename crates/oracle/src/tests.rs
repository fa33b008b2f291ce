use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;
use std::cmp::Ordering;

use super::*;
use accel::{Corners, Hit, Ray, Vec3};

const UNIT: Corners = [Vec3::ZERO, Vec3::X, Vec3::Y];

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
    Ray::new(origin.into(), direction.into())
}

fn reduced(x: &Rational) -> BigRational {
    let fraction = BigRational::new(x.numerator().clone(), x.denominator().clone());
    let power = BigRational::from(BigInt::from(1) << x.exponent().unsigned_abs());
    if x.exponent() >= 0 { fraction * power } else { fraction / power }
}

/// Denormal too, unlike `f32::powi`.
fn power_of_two(e: i32) -> f32 {
    2f64.powi(e) as f32
}

/// Compares oracle and naive solution, and holds the filter to the oracle.
fn check(ray: &Ray, triangle: &Corners) -> Result<(), TestCaseError> {
    let exact = intersect(ray, triangle);
    let naive = super::naive::intersect(ray, triangle);
    match (&exact, &naive) {
        (None, None) => {}
        (Some(e), Some(n)) => {
            prop_assert_eq!([reduced(&e.t), reduced(&e.u), reduced(&e.v)], n.clone())
        }
        _ => prop_assert!(false, "{ray:?} {triangle:?}: {exact:?} but {naive:?}"),
    }
    if let Some(hit) = exact {
        let filter = Filter::new(ray);
        prop_assert!(!filter.rejects(triangle, f64::INFINITY));
        prop_assert!(!filter.rejects(triangle, hit.t.to_f64().next_up()));
    }
    Ok(())
}

/// Few small integers: edges, corners, planes and equal t are met exactly, often.
fn lattice() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![4 => (-3i8..=3).prop_map(f32::from), 1 => Just(-0.0f32), 1 => Just(0.5f32)]
}

fn any_finite() -> impl Strategy<Value = f32> + Clone {
    any::<u32>().prop_map(f32::from_bits).prop_map(|x: f32| if x.is_finite() { x } else { 1.0 })
}

fn vector(of: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Vec3> {
    [of.clone(), of.clone(), of].prop_map(Vec3::from)
}

fn triangle_of(of: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Corners> {
    [vector(of.clone()), vector(of.clone()), vector(of)]
}

/// An affine combination of the corners with rounded weights, some of them 0: nearly
/// or exactly on the triangle, an edge or a corner.
fn aim(triangle: Corners, weights: [u8; 3]) -> Vec3 {
    let sum = weights.iter().map(|w| f32::from(*w)).sum::<f32>().max(1.0);
    (0..3).fold(Vec3::ZERO, |p, k| p + triangle[k] * (f32::from(weights[k]) / sum))
}

fn weights() -> impl Strategy<Value = [u8; 3]> {
    let one = prop_oneof![Just(0u8), Just(1), Just(2), any::<u8>()];
    [one.clone(), one.clone(), one]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn oracle_is_the_naive_solution_on_a_lattice(o in vector(lattice()), d in vector(lattice()), tri in triangle_of(lattice()), range in [lattice(), lattice()], endless: bool) {
        let t_max = if endless { f32::INFINITY } else { range[1] };
        check(&Ray { t_min: range[0], t_max, ..ray(o.into(), d.into()) }, &tri)?;
    }

    #[test]
    fn oracle_is_the_naive_solution_on_aimed_rays(o in vector(-10f32..10.0), tri in triangle_of(-10f32..10.0), w in weights(), e in -140i32..120) {
        let scale = |v: Vec3| v * power_of_two(e);
        let aimed = Ray::new(scale(o), scale(aim(tri, w) - o));
        check(&aimed, &tri.map(scale))?;
        check(&Ray { t_min: 1.0, ..aimed }, &tri.map(scale))?;
        check(&Ray { t_max: 1.0, ..aimed }, &tri.map(scale))?;
    }

    #[test]
    fn oracle_is_the_naive_solution_on_any_floats(o in vector(any_finite()), tri in triangle_of(any_finite()), w in weights(), d in vector(any_finite()), aimed: bool) {
        let target = aim(tri, w) - o;
        let d = if aimed && target.is_finite() { target } else { d };
        check(&Ray { t_min: f32::NEG_INFINITY, ..ray(o.into(), d.into()) }, &tri)?;
    }

    #[test]
    fn the_filter_changes_no_answer(o in vector(lattice()), d in vector(lattice()), list in prop::collection::vec(triangle_of(lattice()), 1..12)) {
        let numbered = || list.iter().enumerate().map(|(id, t)| (id as u32, *t));
        let ray = ray(o.into(), d.into());
        let plain = closest_unfiltered(&ray, numbered());
        prop_assert_eq!(&closest(&ray, numbered()), &plain);
        // Nor does the order of the triangles.
        let backwards = closest(&ray, numbered().collect::<Vec<_>>().into_iter().rev());
        prop_assert_eq!(&backwards, &plain);
    }

    #[test]
    fn rays_through_a_shared_edge_never_pass_between(o in vector(-10f32..10.0), tri in triangle_of(-10f32..10.0), k in 0f32..1.0) {
        // The fourth corner on the other side of the edge 0–1 as the ray sees it.
        let [a, b, c] = tri;
        let across = a + b - c;
        let d = a + (b - a) * k - o;
        let ray = Ray { t_min: f32::NEG_INFINITY, ..Ray::new(o, d) };
        let pair = [(0, tri), (1, [b, a, across])];
        let target_inside = k > 0.001 && k < 0.999;
        let volume = (b - a).cross(c - a).dot(o - a).abs();
        prop_assume!(target_inside && volume > 1.0 && (b - a).length() > 0.5 && (c - a).cross(b - a).length() > 0.5);
        prop_assert!(closest(&ray, pair).is_some());
    }
}

#[test]
fn edges_corners_and_both_sides_count() {
    for (x, y) in [(0.25, 0.25), (0.5, 0.5), (0.0, 0.5), (0.5, 0.0), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] {
        for side in [1.0, -1.0] {
            let hit = intersect(&ray([x, y, 2.0 * side], [-0.0, 0.0, -side]), &UNIT).expect("closed");
            assert_eq!((hit.t.to_f32(), hit.u.to_f32(), hit.v.to_f32()), (2.0, x, y));
        }
    }
    let off = f32::from_bits(1);
    for (x, y) in [(-off, 0.5), (0.5, -off), (0.5f32.next_up(), 0.5), (1.0, off)] {
        assert_eq!(intersect(&ray([x, y, 1.0], [0.0, 0.0, -1.0]), &UNIT), None);
    }
}

#[test]
fn the_range_of_t_is_closed() {
    let third = [Vec3::new(-9.0, -9.0, 1.0), Vec3::new(9.0, -9.0, 1.0), Vec3::new(0.0, 9.0, 1.0)];
    let base = ray([0.0; 3], [0.0, 0.0, 3.0]);
    let t = 1.0f32 / 3.0;
    assert!(Rational::from(t) > intersect(&base, &third).expect("ahead").t);
    // The exact t, 1/3, lies between t and the float before it.
    for (t_min, t_max, expected) in [
        (0.0, t, true),
        (0.0, t.next_down(), false),
        (t.next_down(), 9.0, true),
        (t, 9.0, false),
        (f32::NEG_INFINITY, f32::INFINITY, true),
        (f32::INFINITY, f32::INFINITY, false),
        (0.0, f32::NAN, false),
        (f32::NAN, 9.0, false),
    ] {
        assert_eq!(
            intersect(&Ray { t_min, t_max, ..base }, &third).is_some(),
            expected,
            "[{t_min}, {t_max}]"
        );
    }
    let at_end = ray([0.25, 0.25, 2.0], [0.0, 0.0, -1.0]);
    assert!(intersect(&Ray { t_min: 2.0, t_max: 2.0, ..at_end }, &UNIT).is_some());
    assert!(intersect(&Ray { t_min: 2f32.next_up(), ..at_end }, &UNIT).is_none());
    assert!(intersect(&Ray { t_max: 2f32.next_down(), ..at_end }, &UNIT).is_none());
    // An origin on the surface, with either zero as its range.
    let on = ray([0.25, 0.25, -0.0], [0.1, 0.2, 1e-30]);
    assert!(intersect(&Ray { t_min: -0.0, t_max: 0.0, ..on }, &UNIT).is_some());
}

#[test]
fn rays_in_the_plane_and_flat_triangles_are_missed() {
    assert_eq!(intersect(&ray([-1.0, 0.25, 0.0], [1.0, 0.0, 0.0]), &UNIT), None);
    let segment = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0];
    let point = [Vec3::X; 3];
    for flat in [segment, point] {
        assert_eq!(intersect(&ray([1.0, 0.0, 1.0], [0.0, 0.0, -1.0]), &flat), None);
    }
    assert_eq!(intersect(&ray([0.2, 0.2, 1.0], [0.0, -0.0, 0.0]), &UNIT), None);
    assert_eq!(intersect(&ray([0.2, 0.2, f32::NAN], [0.0, 0.0, 1.0]), &UNIT), None);
    assert!(Filter::new(&ray([0.2, 0.2, f32::INFINITY], [0.0, 0.0, 1.0])).rejects(&UNIT, 9.0));
}

#[test]
fn powers_of_two_change_only_the_exponent() {
    let origin = Vec3::new(0.1, 0.2, 3.0);
    let direction = Vec3::new(0.03, 0.01, -1.0);
    let plain = intersect(&Ray::new(origin, direction), &UNIT).expect("aimed inside");
    for e in [-100i32, -60, 60, 100] {
        let s = power_of_two(e);
        let both = intersect(&Ray::new(origin * s, direction * s), &UNIT.map(|v| v * s)).expect("scaled");
        assert_eq!((&both.t, &both.u, &both.v), (&plain.t, &plain.u, &plain.v));
        let steep = intersect(&Ray::new(origin, direction * s), &UNIT).expect("scaled");
        let back =
            Rational::new(steep.t.numerator().clone(), steep.t.denominator().clone(), steep.t.exponent() + e);
        assert_eq!(back, plain.t);
    }
}

#[test]
fn denormals_are_numbers() {
    let least = f32::from_bits(1);
    let tiny = [Vec3::ZERO, Vec3::X * (4.0 * least), Vec3::Y * (4.0 * least)];
    let down = [0.0, 0.0, -least];
    let hit = intersect(&ray([2.0 * least, 2.0 * least, f32::MAX], down), &tiny).expect("on the edge");
    assert_eq!(hit.t.to_f32(), f32::INFINITY);
    assert_eq!(hit.t.cmp(&Rational::new(BigInt::from(0xff_ffff), 1.into(), 104 + 149)), Ordering::Equal);
    assert_eq!(intersect(&ray([2.0 * least, 3.0 * least, f32::MAX], down), &tiny), None);
}

#[test]
fn exact_ties_go_to_the_lowest_object_and_near_ties_do_not() {
    let down = ray([0.0, 0.0, 1.0], [1.0, 1.0, -3.0]);
    let same = [(7, UNIT), (3, UNIT.map(|v| v * 2.0)), (5, UNIT)];
    assert_eq!(closest(&down, same).map(|(id, _)| id), Some(3));
    // Nearer by one part in 2^149: no float tells their t apart.
    let nearer = UNIT.map(|v| v + Vec3::Z * f32::from_bits(1));
    let (id, hit) = closest(&down, [(3, UNIT), (9, nearer)]).expect("both are hit");
    assert_eq!((id, hit.t.to_f32()), (9, 1.0 / 3.0));
}

#[test]
fn the_filter_leaves_little_to_the_integers() {
    let mut left = 0;
    for i in 0..100i16 {
        for j in 0..100i16 {
            // Parallel to no edge; a 32nd of the grid's area is the triangle's.
            let d = [f32::from(i) * 0.04, f32::from(j) * 0.04, -1.0];
            let filter = Filter::new(&ray([-1.03, -1.01, 1.0], d));
            left += u32::from(!filter.rejects(&UNIT, f64::INFINITY));
        }
    }
    assert!((200..400).contains(&left), "{left} of 10000 left");
}

#[test]
fn planted_faults_are_found() {
    let down = ray([0.25, 0.25, 1.0], [0.0, 0.0, -1.0]);
    let aside = ray([2.0, 2.0, 1.0], [0.0, 0.0, -1.0]);
    let truth = closest(&down, [(4, UNIT)]);
    let hit = |object, t| Some(Hit { t, object, u: 0.25, v: 0.25 });
    let verdict = |reported, exact: &Option<(u32, ExactHit)>| classify(reported, exact.as_ref()).verdict;
    assert_eq!(verdict(hit(4, 1.0), &truth), Verdict::Agree);
    assert_eq!(verdict(None, &truth), Verdict::Missed);
    assert_eq!(verdict(hit(5, 1.0), &truth), Verdict::WrongObject);
    let nothing = closest(&aside, [(4, UNIT)]);
    assert_eq!(verdict(hit(4, 1.0), &nothing), Verdict::False);
    assert_eq!(verdict(None, &nothing), Verdict::Agree);
    let off = classify(hit(4, 1f32.next_up().next_up()), truth.as_ref());
    assert_eq!(off.t_ulp_error, Some(2.0));
}

#[test]
fn an_open_edge_test_is_found_on_edge_rays() {
    // A kernel with > for ≥: strictly inside only.
    let open = |ray: &Ray, tri: &Corners| {
        intersect(ray, tri).filter(|h| {
            let zero = Rational::from(0.0);
            let w = Rational::from(1.0) - &h.u - &h.v;
            h.u > zero && h.v > zero && w > zero
        })
    };
    let mut found = 0;
    for k in 0..=16 {
        let at = k as f32 / 16.0;
        let edge = ray([at, 1.0 - at, 1.0], [0.0, 0.0, -1.0]);
        let reported = open(&edge, &UNIT).map(|h| Hit { t: h.t.to_f32(), object: 0, u: 0.0, v: 0.0 });
        found +=
            u32::from(classify(reported, closest(&edge, [(0, UNIT)]).as_ref()).verdict == Verdict::Missed);
    }
    assert_eq!(found, 17);
}
