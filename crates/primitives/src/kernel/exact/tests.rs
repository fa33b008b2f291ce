use super::strategies::{aim, corners, lattice, vector, weights};
use super::*;
use accel::{Corners, Surface, Vec3};
use lanes::{Level, ROW, Task};
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

/// What is told of a test in advance, and where it is certain what the hit is resolved to.
struct Told<'a>(&'a Ray, &'a Corners);

impl Task for Told<'_> {
    type Out = ([bool; 2], [f32; 2], [f32; 3]);

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Self::Out {
        let Self(ray, triangle) = self;
        let mut group = [Row([0.0; ROW]); <Exact as Kernel>::ROWS];
        Exact::pack(triangle, &mut group, 0);
        let packed = Packed::new(&group, 0);
        let Bounds { undecided, certain, low, high } =
            Exact::bounds_one(s, &Exact::one(ray), packed, 1, ray.t_max);
        let (one, mut rows) = (s.bits(certain) & 1, [[0.0; ROW]; 5]);
        let found = match one {
            0 => nothing(s),
            _ => Exact::resolve(s, &Packet::splat(s, ray), packed.load_corners(s), one),
        };
        for (row, value) in rows.iter_mut().zip([low, high, found.t, found.u, found.v]) {
            s.store(value, row);
        }
        let [low, high, t, u, v] = rows.map(|row| row[0]);
        ([s.bits(undecided) & 1 != 0, one != 0], [low, high], [t, u, v])
    }
}

fn check(ray: &Ray, triangle: &Corners) -> Result<(), TestCaseError> {
    let found = Exact::test(&Exact::one(ray), triangle, ray.t_max);
    let exact = intersect(ray, triangle);
    let beyond = intersect(&Ray { t_max: f32::INFINITY, ..*ray }, triangle);
    let t = beyond.as_ref().map_or(f64::NAN, |hit| hit.t.to_f64());
    for level in Level::here() {
        let ([undecided, certain], [low, high], resolved) = level.run(Told(ray, triangle));
        let text = format!("{level:?} {ray:?} {triangle:?}: {low} to {high}");
        prop_assert!(undecided || exact.is_none(), "{}", text);
        let within = f64::from(low) <= t && t <= f64::from(high);
        prop_assert!(within || !certain && beyond.is_none(), "{}", text);
        if certain && high < ray.t_max {
            let decided = found.map(|Surface { t, u, v }| [t, u, v].map(f32::to_bits));
            prop_assert_eq!(Some(resolved.map(f32::to_bits)), decided, "{}", text);
        }
    }
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
    fn small_triangles_seen_from_afar_are_as_the_oracle_has_them(o in vector(plain()), at in vector(plain()), tri in corners(plain()), w in weights(), less in 0i32..20) {
        let tri = tri.map(|corner| at + corner * power_of_two(-less));
        let aimed = Ray::new(o, aim(&tri, w) - o);
        check(&aimed, &tri)?;
        check(&Ray { t_max: 1.0, ..aimed }, &tri)?;
    }

    /// What there is of scaled t is small then, and of the determinant as much as ever.
    #[test]
    fn rays_that_graze_from_beside_a_corner_are_as_the_oracle_has_them(beside in vector(plain()), tri in corners(plain()), w in weights(), less in 0i32..20) {
        let o = tri[0] + beside * power_of_two(-less);
        let aimed = Ray::new(o, aim(&tri, w) - o);
        check(&aimed, &tri)?;
        check(&Ray { t_max: 0.5, ..aimed }, &tri)?;
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
