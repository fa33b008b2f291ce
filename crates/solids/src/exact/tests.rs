use super::{crossings, estimate, nearest, undecided};
use accel::solid::Sphere;
use accel::testing::spheres_and_rays;
use accel::{Ray, Vec3};
use oracle::{intersect_sphere, sphere_roots};

#[test]
fn the_exact_sphere_equals_the_oracle() {
    let (mut hits, mut open) = (0, 0);
    for (sphere, ray) in spheres_and_rays(6000) {
        let expected = intersect_sphere(&ray, &sphere);
        let found = nearest(&sphere, &ray, ray.t_max);
        assert_eq!(found.map(f32::to_bits), expected.map(f32::to_bits), "{sphere:?} {ray:?}");
        let integers = undecided(&sphere, &ray);
        assert_eq!(integers.map(f32::to_bits), expected.map(f32::to_bits), "{sphere:?} {ray:?}");
        hits += usize::from(found.is_some());
        open += usize::from(estimate(sphere.center.to_array(), sphere.radius, &ray).open);
        let line = Ray { t_min: f32::MIN, t_max: f32::INFINITY, ..ray };
        let both = sphere_roots(&ray, &sphere).map(|roots| roots.map(|root| Some(root.to_f32())));
        assert_eq!(crossings(&sphere, &line), both.unwrap_or_default());
    }
    assert!((1500..4500).contains(&hits) && open < 600, "{hits} hits, {open} left open");
}

#[test]
fn exact_touches_and_ranges_are_told() {
    let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let ray = |y: f32| Ray::new(Vec3::new(-3.0, y, 0.0), Vec3::X);
    assert_eq!(nearest(&ball, &ray(1.0), 9.0), Some(3.0));
    assert_eq!(nearest(&ball, &ray(1f32.next_up()), 9.0), None);
    assert_eq!(nearest(&ball, &ray(0.0), 2.0), Some(2.0));
    assert_eq!(nearest(&ball, &ray(0.0), 2f32.next_down()), None);
    let late = Ray { t_min: 2f32.next_up(), ..ray(0.0) };
    assert_eq!(nearest(&ball, &late, 9.0), Some(4.0));
}
