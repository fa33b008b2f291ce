//! Ray against sphere, without any rounding.

use std::cmp::Ordering;

use super::integers::common_exponent;
use super::rational::Rational;
use accel::Ray;
use accel::solid::Sphere;
use num_bigint::BigInt;
use num_traits::Zero;

/// A root of a ray's quadratic equation with a sphere: (b ± √D)/a · 2^exponent, which is irrational as a rule. It
/// is kept as integers, by which it is compared and rounded without error.
#[derive(Clone, Debug)]
pub struct Root {
    a: BigInt,
    b: BigInt,
    discriminant: BigInt,
    exponent: i32,
    second: bool,
}

/// Bits of the square root that are looked at before integers decide.
const EXTRA: u32 = 128;

impl Root {
    /// Where the root lies relative to a finite `value`.
    fn compare(&self, value: &Rational) -> Ordering {
        // (b ± √D) · 2^e / a against n/d · 2^k: ± √D against a·n·2^(k−e)/d − b, both times d > 0.
        let mut rest = &self.a * value.numerator();
        let mut scale = value.denominator().clone();
        let shift = value.exponent() - self.exponent;
        if shift >= 0 {
            rest <<= shift
        } else {
            scale <<= -shift
        }
        let rest = rest - &self.b * &scale;
        let square = &self.discriminant * &scale * &scale;
        let rest_square = &rest * &rest;
        let negative = rest < BigInt::zero();
        match (self.second, negative) {
            (true, true) => Ordering::Greater,
            (true, false) => square.cmp(&rest_square),
            (false, false) if !rest.is_zero() => Ordering::Less,
            (false, _) => rest_square.cmp(&square),
        }
    }

    /// Where the root lies relative to `value`, which may be infinite but no NaN.
    pub fn cmp_f32(&self, value: f32) -> Ordering {
        if value.is_infinite() {
            return if value > 0.0 { Ordering::Less } else { Ordering::Greater };
        }
        self.compare(&Rational::from(value))
    }

    /// The nearest `f32`, ties to even.
    pub fn to_f32(&self) -> f32 {
        let root = (&self.discriminant << (2 * EXTRA)).sqrt();
        let b = &self.b << EXTRA;
        let numerator = if self.second { b + root } else { b - root };
        let near = Rational::new(numerator, &self.a << EXTRA, self.exponent);
        let mut found = near.to_f32();
        // The root taken is off by less than one unit: at most a neighbour is the right one.
        for (other, beyond) in [(found.next_up(), Ordering::Greater), (found.next_down(), Ordering::Less)] {
            if found.is_finite() && other.is_finite() {
                let middle = middle(found, other);
                let side = self.compare(&middle);
                let even = other.to_bits() & 1 == 0;
                if side == beyond || (side.is_eq() && even) {
                    found = other;
                }
            }
        }
        found + 0.0
    }
}

/// Half way between two numbers.
fn middle(a: f32, b: f32) -> Rational {
    let ([a, b], exponent) = common_exponent([a, b]);
    Rational::new(a + b, BigInt::from(2), exponent)
}

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
    let root = |second| Root {
        a: a.clone(),
        b: b.clone(),
        discriminant: discriminant.clone(),
        exponent: at - along,
        second,
    };
    Some([root(false), root(true)])
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
