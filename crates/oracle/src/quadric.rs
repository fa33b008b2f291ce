//! Ray against quadric, without any rounding.

use super::integers::common_exponent;
use super::root::Root;
use accel::Ray;
use accel::solid::Quadric;
use num_bigint::{BigInt, Sign};
use num_traits::{Signed, Zero};

/// Where F of a quadric is 0 along a ray's line, its box being left out of account.
#[derive(Clone, Debug)]
pub enum Roots {
    /// Nowhere, or everywhere: F has this sign.
    None(Sign),
    /// Once: F is linear along the line.
    One(Root),
    /// Twice, in order; equal roots where the line touches. Between them F is not above 0 if `inside` is set, else not below.
    Two {
        /// Where.
        roots: [Root; 2],
        /// Whether the quadric is between them.
        inside: bool,
    },
}

impl Roots {
    /// All of them, in order.
    pub fn as_slice(&self) -> &[Root] {
        match self {
            Self::None(_) => &[],
            Self::One(root) => std::slice::from_ref(root),
            Self::Two { roots, .. } => roots,
        }
    }
}

/// Where F is 0 along the ray's line, whatever its range.
///
/// `None` for a ray that is none (NaN or infinite, without direction), or a quadric with numbers that are not finite.
pub fn quadric_roots(ray: &Ray, quadric: &Quadric) -> Option<Roots> {
    let (min, max) = (quadric.bounds.min, quadric.bounds.max);
    let usable = quadric.coefficients.iter().all(|c| c.is_finite()) && min.is_finite() && max.is_finite();
    if !usable || ray.validate().is_err() {
        return None;
    }
    let (q, _) = common_exponent(quadric.coefficients);
    let [ox, oy, oz] = ray.origin.to_array();
    let (points, places) = common_exponent([ox, oy, oz, min.x, min.y, min.z, max.x, max.y, max.z]);
    let (d, along) = common_exponent(ray.direction.to_array());
    // The origin relative to the middle of the box, in halves of that unit, which must not be above 1: F has terms of three degrees.
    let shift = (places - 1).max(0);
    let unit = (places - 1).min(0);
    let f: [BigInt; 3] =
        std::array::from_fn(|i| ((&points[i] << 1) - &points[3 + i] - &points[6 + i]) << shift);
    let [xx, yy, zz, xy, xz, yz, x, y, z, one] = &q;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let dot = |u: &[BigInt; 3], v: &[BigInt; 3]| -> BigInt { (0..3).map(|i| &u[i] * &v[i]).sum() };
    let times = |v: &[BigInt; 3]| rows.map(|row| (0..3).map(|i| row[i] * &v[i]).sum::<BigInt>());
    let linear = [x, y, z].map(|c| c << -unit);
    // a·s² + 2·b·s + c for t = s·2^(unit − along).
    let of_d = times(&d);
    let mut a = dot(&of_d, &d);
    let mut b = dot(&of_d, &f) + dot(&linear, &d);
    let c: BigInt = dot(&times(&f), &f) + (dot(&linear, &f) << 1) + (one << (-2 * unit));
    let exponent = unit - along;
    if a.is_zero() {
        let Some(sign) = (!b.is_zero()).then(|| b.sign()) else { return Some(Roots::None(c.sign())) };
        let n = if sign == Sign::Plus { -&c } else { c };
        return Some(Roots::One(Root::quotient(n, b.abs() << 1, exponent)));
    }
    let square = &b * &b - &a * &c;
    if square.is_negative() {
        return Some(Roots::None(c.sign()));
    }
    let inside = a.is_positive();
    if inside {
        b = -b;
    } else {
        a = -a;
    }
    Some(Roots::Two { roots: Root::both(a, b, square, exponent), inside })
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Aabb, Vec3};
    use std::cmp::Ordering;

    fn quadric(coefficients: [f32; 10], center: Vec3) -> Quadric {
        let half = Vec3::splat(4.0);
        Quadric { coefficients, bounds: Aabb { min: center - half, max: center + half } }
    }

    fn ts(ray: &Ray, quadric: &Quadric) -> Vec<f32> {
        quadric_roots(ray, quadric).unwrap().as_slice().iter().map(Root::to_f32).collect()
    }

    #[test]
    fn each_form_has_its_roots() {
        let ball = quadric([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0], Vec3::X * 10.0);
        let ray = Ray::new(Vec3::ZERO, Vec3::X * 2.0);
        assert_eq!(ts(&ray, &ball), [4.0, 6.0]);
        let touching = Ray { origin: Vec3::Y * 2.0, ..ray };
        assert_eq!(ts(&touching, &ball), [5.0, 5.0]);
        let beside = Ray { origin: Vec3::Y * 2f32.next_up(), ..ray };
        assert!(matches!(quadric_roots(&beside, &ball), Some(Roots::None(Sign::Plus))));
        // z ≤ x² − 1 about the origin, along x and along z.
        let trough = quadric([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1.0], Vec3::ZERO);
        let along = Ray::new(Vec3::X * -3.0, Vec3::X);
        assert_eq!(ts(&along, &trough), [2.0, 4.0]);
        assert!(matches!(quadric_roots(&along, &trough), Some(Roots::Two { inside: false, .. })));
        let up = Ray::new(Vec3::new(3.0, 0.0, -3.0), Vec3::Z);
        assert_eq!(ts(&up, &trough), [11.0]);
        let aside = Ray { direction: Vec3::Y, ..up };
        assert!(matches!(quadric_roots(&aside, &trough), Some(Roots::None(Sign::Minus))));
    }

    #[test]
    fn a_ball_as_a_quadric_has_the_roots_of_the_ball() {
        use crate::sphere_roots;
        let mut count = 0;
        for (sphere, ray) in accel::testing::spheres_and_rays(400) {
            let half = Vec3::splat(2.0 * sphere.radius);
            let bounds = Aabb { min: sphere.center - half, max: sphere.center + half };
            // Where the box's middle and the square of the radius are no `f32`, it is another ball.
            let radius = f32::from_bits(sphere.radius.to_bits() & !0xfff);
            let sphere = accel::solid::Sphere { radius, ..sphere };
            if (bounds.min + bounds.max) * 0.5 != sphere.center || !(1e-9..1e9).contains(&radius) {
                continue;
            }
            let coefficients = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -radius * radius];
            let exact = f64::from(bounds.min.x) + f64::from(bounds.max.x) == 2.0 * f64::from(sphere.center.x)
                && f64::from(bounds.min.y) + f64::from(bounds.max.y) == 2.0 * f64::from(sphere.center.y)
                && f64::from(bounds.min.z) + f64::from(bounds.max.z) == 2.0 * f64::from(sphere.center.z);
            if !exact {
                continue;
            }
            let found = quadric_roots(&ray, &Quadric { coefficients, bounds }).unwrap();
            let expected = sphere_roots(&ray, &sphere);
            assert_eq!(found.as_slice().len(), if expected.is_some() { 2 } else { 0 });
            for (found, expected) in found.as_slice().iter().zip(expected.iter().flatten()) {
                assert_eq!(found.to_f32(), expected.to_f32());
                assert_eq!(found.cmp_f32(expected.to_f32()), expected.cmp_f32(expected.to_f32()));
                assert_ne!(found.cmp_f32(f32::INFINITY), Ordering::Greater);
                count += 1;
            }
        }
        assert!(count > 50, "{count}");
    }
}
