//! Ray against sphere, without any rounding.

use super::integers::common_exponent;
use super::root::Root;
use accel::Ray;
use accel::solid::Sphere;
use num_bigint::BigInt;
use num_traits::Zero;

/// Where the ray's line enters and leaves a ball; equal roots where it touches.
///
/// `None` where it misses, and for a ray or a ball that is none: NaN or infinite, without direction, or with a radius that is not
/// above 0.
pub fn sphere_roots(ray: &Ray, sphere: &Sphere) -> Option<[Root; 2]> {
    let usable = sphere.center.is_finite() && sphere.radius.is_finite() && sphere.radius > 0.0;
    if !usable || ray.validate().is_err() {
        return None;
    }
    let ([ox, oy, oz], [cx, cy, cz]) = (ray.origin.to_array(), sphere.center.to_array());
    let ([ox, oy, oz, cx, cy, cz, r], at) = common_exponent([ox, oy, oz, cx, cy, cz, sphere.radius]);
    let (d, along) = common_exponent(ray.direction.to_array());
    let f = [ox - cx, oy - cy, oz - cz];
    let dot = |u: &[BigInt; 3], v: &[BigInt; 3]| -> BigInt { (0..3).map(|i| &u[i] * &v[i]).sum() };
    let (a, b, c) = (dot(&d, &d), -dot(&f, &d), dot(&f, &f) - &r * &r);
    let discriminant = &b * &b - &a * &c;
    if discriminant < BigInt::zero() {
        return None;
    }
    Some(Root::both(a, b, discriminant, at - along))
}

/// The t of the ray's first hit on a sphere with its true t in `[t_min, t_max]`, rounded to the nearest `f32`.
pub fn intersect_sphere(ray: &Ray, sphere: &Sphere) -> Option<f32> {
    let within = |root: &Root| root.cmp_f32(ray.t_min).is_ge() && root.cmp_f32(ray.t_max).is_le();
    sphere_roots(ray, sphere)?.into_iter().find(within).map(|root| root.to_f32())
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;

    #[test]
    fn roots_are_compared_and_rounded_without_error() {
        let ball = |radius| Sphere { center: Vec3::new(3.0, 0.0, 0.0), radius };
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        assert_eq!(intersect_sphere(&ray, &ball(1.0)), Some(2.0));
        assert_eq!(intersect_sphere(&Ray { t_min: 2.0, ..ray }, &ball(1.0)), Some(2.0));
        assert_eq!(intersect_sphere(&Ray { t_min: 2.1, ..ray }, &ball(1.0)), Some(4.0));
        assert_eq!(intersect_sphere(&Ray { t_min: 2.1, t_max: 3.9, ..ray }, &ball(1.0)), None);
        // 1/√2 of a slanted ray through the middle.
        let slanted = Ray::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0));
        let unit = Sphere { center: Vec3::ZERO, radius: 1.0 };
        let [first, second] = sphere_roots(&slanted, &unit).unwrap();
        assert_eq!(
            (first.to_f32(), second.to_f32()),
            (-std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2)
        );
        assert!(second.cmp_f32(second.to_f32()).is_ne());
    }

    #[test]
    fn touching_is_told_from_missing() {
        let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
        let at = |y: f32| sphere_roots(&Ray::new(Vec3::new(-1e7, y, 0.0), Vec3::X), &ball);
        let [a, b] = at(1.0).unwrap();
        assert_eq!((a.to_f32(), b.to_f32()), (1e7, 1e7));
        assert!(at(1f32.next_up()).is_none());
        assert!(at(1f32.next_down()).is_some());
    }
}
