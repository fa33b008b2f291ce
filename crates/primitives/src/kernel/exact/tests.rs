use super::strategies::{aim, corners, lattice, vector, weights};
use super::*;
use accel::{Corners, Vec3};
use lanes::ROW;
use oracle::intersect;
use proptest::prelude::*;

fn power_of_two(e: i32) -> f32 {
    2f64.powi(e) as f32
}

fn plain() -> impl Strategy<Value = f32> + Clone {
    -3f32..3.0
}

fn any_finite() -> impl Strategy<Value = f32> + Clone {
    any::<u32>().prop_map(f32::from_bits).prop_map(|x| if x.is_finite() { x } else { 1.0 })
}

fn check(ray: &Ray, triangle: &Corners) -> Result<(), TestCaseError> {
    let found = Exact::test(&Exact::one(ray), triangle, ray.t_max);
    let exact = intersect(ray, triangle);
    let mut group = [Row([0.0; ROW]); <Exact as Kernel>::ROWS];
    Exact::pack(triangle, &mut group, 0);
    let bounds = Exact::bounds_one(Scalar, &Exact::one(ray), Packed::new(&group, 0), 1, ray.t_max);
    prop_assert!(bounds.undecided || exact.is_none(), "{:?} {:?}", ray, triangle);
    let beyond = intersect(&Ray { t_max: f32::INFINITY, ..*ray }, triangle);
    let t = beyond.as_ref().map_or(f64::NAN, |hit| hit.t.to_f64());
    let within = f64::from(bounds.low) <= t && t <= f64::from(bounds.high);
    let text = format!("{ray:?} {triangle:?}: {} to {}", bounds.low, bounds.high);
    prop_assert!(within || !bounds.certain && beyond.is_none(), "{}", text);
    prop_assert_eq!(found.map(|s| s.t), exact.as_ref().map(|hit| hit.t.to_f32()), "{:?} {:?}", ray, triangle);
    if let (Some(found), Some(exact)) = (found, exact) {
        let near = |a: f32, b: f32| (a - b).abs() <= f32::EPSILON;
        prop_assert!(near(found.u, exact.u.to_f32()) && near(found.v, exact.v.to_f32()));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn decisions_are_the_oracles_on_a_lattice(o in vector(lattice()), d in vector(lattice()), tri in corners(lattice()), range in [lattice(), lattice()]) {
        check(&Ray { t_min: range[0], t_max: range[1], ..Ray::new(o, d) }, &tri)?;
        check(&Ray::new(o, d), &tri)?;
    }

    #[test]
    fn decisions_are_the_oracles_on_aimed_rays(o in vector(plain()), tri in corners(plain()), w in weights(), offset in prop_oneof![Just(0f32), Just(1e3), Just(1.5e5), Just(1e7)], needle in prop_oneof![Just(1f32), Just(1e-7)]) {
        let [a, b, c] = tri;
        let tri = [a, b, b + (c - b) * needle].map(|v| v + Vec3::splat(offset));
        let o = o + Vec3::splat(offset);
        let aimed = Ray::new(o, aim(&tri, w) - o);
        check(&aimed, &tri)?;
        for step in [-1, 1] {
            let mut d = aimed.direction;
            d.x = if step < 0 { d.x.next_down() } else { d.x.next_up() };
            check(&Ray { direction: d, ..aimed }, &tri)?;
        }
        // The range begins or ends at the reported t.
        if let Some(hit) = Exact::test(&Exact::one(&aimed), &tri, aimed.t_max) {
            for t in [hit.t, hit.t.next_down(), hit.t.next_up()] {
                check(&Ray { t_min: t, ..aimed }, &tri)?;
                check(&Ray { t_max: t, ..aimed }, &tri)?;
            }
        }
    }

    #[test]
    fn decisions_are_the_oracles_at_every_scale(o in vector(plain()), tri in corners(plain()), w in weights(), e in -149i32..120, f in -149i32..120) {
        let s = power_of_two(e);
        let tri = tri.map(|v| v * s);
        let o = o * s;
        let d = aim(&tri, w) - o;
        check(&Ray::new(o, d), &tri)?;
        check(&Ray::new(o, (d / s.max(1e-38)) * power_of_two(f)), &tri)?;
    }

    #[test]
    fn decisions_are_the_oracles_on_any_floats(o in vector(any_finite()), d in vector(any_finite()), tri in corners(any_finite()), w in weights(), aimed: bool) {
        let target = aim(&tri, w) - o;
        let d = if aimed && target.is_finite() { target } else { d };
        check(&Ray { t_min: f32::NEG_INFINITY, ..Ray::new(o, d) }, &tri)?;
    }
}
