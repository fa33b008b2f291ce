use super::{Estimate, Integers, estimate, nearest};
use accel::solid::Sphere;
use accel::testing::random;
use accel::{Ray, Vec3};
use oracle::intersect_sphere;

/// Rays about a sphere, every second of them within a few millionths of its silhouette, at many scales and places.
fn cases(count: u32) -> impl Iterator<Item = (Sphere, Ray)> {
    let mut random = random(61);
    (0..count).map(move |i| {
        let mut point = || Vec3::new(random(), random(), random());
        let (center, away, aside, aim) = (point(), point(), point(), point());
        let scale = [1.0, 2f32.powi(60), 2f32.powi(-60), 16.0][i as usize / 2 % 4];
        let offset = if i % 3 == 0 { Vec3::new(1e7, -1e7, 1e7) } else { Vec3::ZERO };
        let center = (center + offset) * scale;
        let radius = (0.2 + aim.x.abs()) * scale;
        let direction = away.as_dvec3().normalize_or(glam::DVec3::X);
        let across = direction.cross(aside.as_dvec3()).normalize_or(glam::DVec3::Y);
        let miss = if i.is_multiple_of(2) { 1.0 + f64::from(aim.y) * 1e-6 } else { f64::from(aim.z) * 1.2 };
        let far = f64::from(scale) * f64::from(2.0 + aim.y.abs() * 20.0);
        let origin = center.as_dvec3() + across * (miss * f64::from(radius)) - direction * far;
        let ray = Ray::new(origin.as_vec3(), (direction * f64::from(0.1 + aim.x.abs())).as_vec3());
        let t_max = if i % 7 == 0 { (far * 2.0) as f32 } else { f32::INFINITY };
        (Sphere { center, radius }, Ray { t_max, ..ray })
    })
}

#[test]
fn the_exact_sphere_equals_the_oracle() {
    let (mut hits, mut open) = (0, 0);
    for (sphere, ray) in cases(6000) {
        let expected = intersect_sphere(&ray, &sphere);
        let found = nearest(&sphere, &ray, ray.t_max);
        assert_eq!(found.map(f32::to_bits), expected.map(f32::to_bits), "{sphere:?} {ray:?}");
        let integers = Integers::of(&sphere, &ray).and_then(|i| i.nearest(ray.t_min, ray.t_max));
        assert_eq!(integers.map(f32::to_bits), expected.map(f32::to_bits), "{sphere:?} {ray:?}");
        hits += usize::from(found.is_some());
        open += usize::from(matches!(estimate(&sphere, &ray, ray.t_max), Estimate::Open));
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
