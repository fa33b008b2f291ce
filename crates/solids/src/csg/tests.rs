use super::*;
use crate::tests::crossings;
use accel::solid::{Cone, Expression, Implicit, Sphere, Torus};
use accel::{Aabb, Vec3};
use proptest::prelude::*;
use std::sync::Arc;

fn ball(x: f32, radius: f32) -> Solid {
    Solid::Sphere(Sphere { center: Vec3::X * x, radius })
}

fn block(min: Vec3, max: Vec3) -> Solid {
    Solid::Box(Aabb { min, max })
}

fn both(combination: Combination, first: Solid, second: Solid) -> Solid {
    Solid::Csg(Csg::new(combination, first, second))
}

#[test]
fn two_balls() {
    let ray = Ray { t_min: -100.0, ..Ray::new(Vec3::X * -5.0, Vec3::X) };
    let of = |combination| crossings(&both(combination, ball(0.0, 1.0), ball(1.0, 1.0)), &ray);
    assert_eq!(of(Combination::Union), [(4.0, true), (7.0, false)]);
    assert_eq!(of(Combination::Intersection), [(5.0, true), (6.0, false)]);
    assert_eq!(of(Combination::Difference), [(4.0, true), (5.0, false)]);
}

#[test]
fn surfaces_that_touch_leave_nothing_between() {
    let ray = Ray::new(Vec3::new(-5.0, 0.5, 0.5), Vec3::X);
    let (low, high) = (block(Vec3::ZERO, Vec3::ONE), block(Vec3::X, Vec3::new(2.0, 1.0, 1.0)));
    assert_eq!(
        crossings(&both(Combination::Union, low.clone(), high.clone()), &ray),
        [(5.0, true), (7.0, false)]
    );
    assert_eq!(crossings(&both(Combination::Intersection, low.clone(), high.clone()), &ray), []);
    assert_eq!(
        crossings(&both(Combination::Difference, low.clone(), high), &ray),
        [(5.0, true), (6.0, false)]
    );
    assert_eq!(crossings(&both(Combination::Difference, low.clone(), low), &ray), []);
}

#[test]
fn a_range_begins_inside() {
    let plate = block(Vec3::new(-2.0, -2.0, -0.5), Vec3::new(2.0, 2.0, 0.5));
    let bore = Cone { base: Vec3::Z * -1.0, base_radius: 1.0, top: Vec3::Z, top_radius: 1.0 };
    let part = both(Combination::Difference, plate, Solid::Cone(bore));
    let ray = Ray { t_min: 2.25, ..Ray::new(Vec3::X * -4.0, Vec3::X) };
    assert_eq!(crossings(&part, &ray), [(3.0, false), (5.0, true), (6.0, false)]);
    assert_eq!(crossings(&part, &Ray::new(Vec3::new(0.1, 0.2, 5.0), Vec3::NEG_Z)), []);
}

/// Solids of every closed kind about the origin.
fn leaf() -> impl Strategy<Value = Solid> {
    let point = || [-0.7f32..0.7, -0.7..0.7, -0.7..0.7].prop_map(Vec3::from);
    let function =
        Arc::new(Expression::parse("sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)").unwrap());
    prop_oneof![
        (point(), 0.2f32..1.0).prop_map(|(center, radius)| Solid::Sphere(Sphere { center, radius })),
        (point(), point()).prop_map(|(a, b)| Solid::Box(Aabb::of_points([a, b]))),
        (point(), 0.1f32..0.5).prop_map(|(top, r)| Solid::Cone(Cone {
            base: Vec3::splat(-0.8),
            base_radius: r,
            top,
            top_radius: 0.5 - r
        })),
        (point(), 0.4f32..0.8).prop_map(|(axis, major)| Solid::Torus(Torus {
            center: Vec3::ZERO,
            axis: axis + Vec3::X,
            major,
            minor: 0.3
        })),
        point().prop_map(move |p| Solid::Implicit(Implicit::new(
            function.clone(),
            Aabb::of_points([Vec3::splat(-0.9), p])
        ))),
    ]
}

fn tree() -> impl Strategy<Value = Solid> {
    let combination =
        prop::sample::select(vec![Combination::Union, Combination::Intersection, Combination::Difference]);
    leaf().prop_recursive(3, 8, 2, move |inner| {
        (combination.clone(), inner.clone(), inner).prop_map(|(c, a, b)| both(c, a, b))
    })
}

/// Whether a place of a line is inside, by its parts' own crossings.
fn holds(solid: &Solid, line: &Ray, t: f64) -> bool {
    match solid {
        Solid::Csg(Csg { combination, parts }) => {
            combination.holds([holds(&parts[0], line, t), holds(&parts[1], line, t)])
        }
        leaf => {
            crossings(leaf, line)
                .iter()
                .filter(|(at, _)| *at < t)
                .map(|(_, enters)| if *enters { 1 } else { -1 })
                .sum::<i32>()
                > 0
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn sets_are_those_of_their_members(
        tree in tree(),
        from in [-2f32..2.0, -2.0..2.0, -2.0..2.0],
        to in [-1f32..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        prop_assume!(from != to);
        let line = Ray { t_min: f32::MIN, ..Ray::new(Vec3::from(from), Vec3::from(to) - Vec3::from(from)) };
        let found = crossings(&tree, &line);
        prop_assert!(found.iter().enumerate().all(|(i, (_, enters))| *enters == (i % 2 == 0)), "{:?}", found);
        for i in 0..500 {
            let t = -6.0 + 0.024 * f64::from(i) + 1e-5;
            let inside = found.iter().filter(|(at, _)| *at < t).count() % 2 == 1;
            prop_assert_eq!(inside, holds(&tree, &line, t), "{} of {:?}", t, line);
        }
        let later = Ray { t_min: 0.3, ..line };
        let expected: Vec<_> = found.into_iter().filter(|(t, _)| *t as f32 >= 0.3).collect();
        prop_assert_eq!(crossings(&tree, &later), expected);
    }
}
