use super::*;
use crate::tests::crossings;
use accel::solid::{Expression, Sphere};
use accel::{Aabb, Vec3};
use proptest::prelude::*;
use std::sync::Arc;

fn implicit(text: &str, half: f32) -> Implicit {
    let bounds = Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) };
    Implicit::new(Arc::new(Expression::parse(text).unwrap()), bounds)
}

#[test]
fn a_ball_is_where_the_sphere_is() {
    let solid = implicit("x^2 + y^2 + z^2 - 1", 2.0);
    let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let mut random = accel::testing::random(3);
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let mut hits = 0;
    for _ in 0..2000 {
        let origin = point(3.0);
        let ray = Ray::new(origin, point(1.0) - origin);
        let (found, expected) = (solid.nearest(&ray, f32::INFINITY), sphere.nearest(&ray, f32::INFINITY));
        assert_eq!(found.is_some(), expected.is_some(), "{ray:?}");
        if let (Some(a), Some(b)) = (found, expected) {
            assert!((a.t - b.t).abs() <= 2e-6 * (1.0 + b.t.abs()), "{ray:?}: {} {}", a.t, b.t);
            hits += 1;
        }
    }
    assert!(hits > 200);
}

#[test]
fn faces_of_the_box_close_it() {
    let solid = implicit("y - 0.5", 1.0);
    let down = Ray::new(Vec3::new(0.0, 3.0, 0.0), Vec3::NEG_Y);
    assert_eq!(crossings(&solid, &down), [(2.5, true), (4.0, false)]);
    let along = Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X);
    assert_eq!(crossings(&solid, &along), [(2.0, true), (4.0, false)]);
    let above = Ray::new(Vec3::new(-3.0, 0.75, 0.0), Vec3::X);
    assert_eq!(crossings(&solid, &above), []);
}

#[test]
fn rays_in_the_surface_and_touching_ones_end() {
    for (text, ray) in [
        ("z", Ray::new(Vec3::new(-3.0, 0.1, 0.0), Vec3::X)),
        ("x*y*z", Ray::new(Vec3::new(-3.0, 0.1, 0.0), Vec3::X)),
        ("x^2 + y^2 - 0.25", Ray::new(Vec3::new(0.5, 0.0, -3.0), Vec3::Z)),
        ("x^2 + y^2 + z^2 - 1", Ray::new(Vec3::new(-3.0, 1.0, 0.0), Vec3::X)),
        ("sin(5*x) + z - z", Ray::new(Vec3::new(0.0, -3.0, 0.3), Vec3::Y)),
        ("(x - 0.3)^6", Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X)),
        ("abs(x) - abs(x)", Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X)),
    ] {
        let found = crossings(&implicit(text, 1.5), &ray);
        assert_eq!(found.len() % 2, 0, "{text}: {found:?}");
    }
}

#[test]
fn a_range_changes_no_root() {
    let solid = implicit("sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)", 2.0);
    let mut random = accel::testing::random(5);
    let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
    let mut compared = 0;
    for _ in 0..300 {
        let ray = Ray { t_min: -100.0, ..Ray::new(point(3.0), point(1.0)) };
        let all = crossings(&solid, &ray);
        assert_eq!(all.len() % 2, 0);
        assert!(all.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 != pair[1].1));
        for pair in all.windows(2) {
            let t_min = (0.5 * (pair[0].0 + pair[1].0)) as f32;
            let later: Vec<_> = all.iter().filter(|(t, _)| *t as f32 >= t_min).copied().collect();
            assert_eq!(crossings(&solid, &Ray { t_min, ..ray }), later);
            let nearest = solid.nearest(&Ray { t_min, ..ray }, pair[1].0 as f32);
            assert_eq!(nearest.map(|s| s.t), later.first().map(|(t, _)| *t as f32 + 0.0));
            compared += 1;
        }
    }
    assert!(compared > 500);
}

/// Shapes with thin walls, cusps and many roots on a line.
const SHAPES: [&str; 7] = [
    "sin(6*x)*cos(6*y) + sin(6*y)*cos(6*z) + sin(6*z)*cos(6*x)",
    "(x^2 + 9/4*y^2 + z^2 - 1)^3 - x^2*z^3 - 9/80*y^2*z^3",
    "(x^2 + y^2 + z^2 + 0.8)^2 - 3.4*(x^2 + y^2)",
    "abs(x) + abs(y) + abs(z) - 1.1",
    "(sin(5*x)*cos(5*y) + sin(5*y)*cos(5*z) + sin(5*z)*cos(5*x))^2 - 0.01",
    "max(x^2 + y^2 - 0.5, min(z - 0.2, -z - 0.2))",
    "x^4 - 2*x^2 + y^4 - 2*y^2 + z^4 - 2*z^2 + 1.8",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// What a far finer search sees is there, and nothing else; what lies closer together than its steps may be more.
    #[test]
    fn no_root_is_stepped_over(
        shape in prop::sample::select(SHAPES.to_vec()),
        from in [-2f32..2.0, -2.0..2.0, -2.0..2.0],
        to in [-1f32..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        prop_assume!(from != to);
        let solid = implicit(shape, 1.5);
        let ray = Ray { t_min: -1e6, ..Ray::new(Vec3::from(from), Vec3::from(to) - Vec3::from(from)) };
        let found = crossings(&solid, &ray);
        prop_assert_eq!(found.len() % 2, 0);
        let Some((near, far)) = solid.bounds().overlap(ray.origin, ray.direction) else {
            prop_assert!(found.is_empty());
            return Ok(());
        };
        let steps = 20_000;
        let at = |i: i32| near + (far - near) * f64::from(i) / f64::from(steps);
        let value = |t: f64| {
            let p = ray.origin.as_dvec3() + ray.direction.as_dvec3() * t;
            solid.function.value(p.to_array())
        };
        for i in 1..steps {
            let (a, b) = (at(i), at(i + 1));
            if i + 1 < steps && (value(a) < 0.0) != (value(b) < 0.0) {
                let slack = (b - a) * 1e-3;
                let within = found.iter().filter(|(t, _)| a - slack <= *t && *t <= b + slack).count();
                prop_assert!(within % 2 == 1 || within > 0, "{} {:?}: none between {} and {}: {:?}", shape, ray, a, b, found);
            }
        }
        for (t, enters) in &found {
            let step = (far - near) * 1e-7;
            let inside = |t: f64| near < t && t < far && value(t) < 0.0;
            // Where F changes its sign as told, give or take what is told apart.
            if found.iter().filter(|(other, _)| (other - t).abs() < 4.0 * step).count() == 1 {
                prop_assert_eq!(inside(t + step), *enters, "{} {:?}: {}", shape, ray, t);
                prop_assert_eq!(inside(t - step), !*enters, "{} {:?}: {}", shape, ray, t);
            }
        }
    }
}
