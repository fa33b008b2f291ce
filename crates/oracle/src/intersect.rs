//! One ray against one triangle, by integers.

use num_bigint::{BigInt, Sign};
use num_traits::Zero;
use std::cmp::Ordering;

use super::integers::common_exponent;
use super::rational::Rational;
use accel::{Corners, Ray};

/// A hit without rounding: what [`accel::Surface`] and [`accel::Hit`] approximate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExactHit {
    /// The ray's parameter at the hit, in units of its direction.
    pub t: Rational,
    /// Weight of the second corner, in [0, 1].
    pub u: Rational,
    /// Weight of the third corner, in [0, 1].
    pub v: Rational,
}

impl ExactHit {
    /// Signed error of a reported t in ulps of `f32` at the true t; see
    /// [`Rational::ulp_error`].
    pub fn t_ulp_error(&self, reported: f32) -> f64 {
        self.t.ulp_error(reported)
    }
}

/// The hit of `ray` on the closed triangle, decided and computed exactly; what counts
/// as one is said in the [module](super).
pub fn intersect(ray: &Ray, triangle: &Corners) -> Option<ExactHit> {
    if !usable(ray, triangle) {
        return None;
    }
    let [v0, v1, v2] = triangle;
    let o = ray.origin;
    let (points, point_exponent) =
        common_exponent([o.x, o.y, o.z, v0.x, v0.y, v0.z, v1.x, v1.y, v1.z, v2.x, v2.y, v2.z]);
    let (d, direction_exponent) = common_exponent(ray.direction.to_array());
    let corner =
        |k: usize| -> [BigInt; 3] { std::array::from_fn(|axis| &points[3 * k + axis] - &points[axis]) };
    let (a, b, c) = (corner(1), corner(2), corner(3));

    // Six times the volumes that the ray's line spans with the edges.
    let u = triple(&d, &a, &c);
    let v = triple(&d, &b, &a);
    let w = triple(&d, &c, &b);
    let signs = [u.sign(), v.sign(), w.sign()];
    if signs.contains(&Sign::Plus) && signs.contains(&Sign::Minus) {
        return None;
    }
    let det = &u + &v + &w;
    if det.is_zero() {
        return None;
    }
    // t·d·n = a·n with n = (b−a)×(c−a); det = −d·n and a·n = a·(b×c).
    let t = Rational::new(triple(&a, &c, &b), det.clone(), point_exponent - direction_exponent);
    let within = t.compare(ray.t_min)? != Ordering::Less && t.compare(ray.t_max)? != Ordering::Greater;
    within.then(|| ExactHit { t, u: Rational::new(u, det.clone(), 0), v: Rational::new(v, det, 0) })
}

/// Whether every number is one: see the [module](super).
pub(super) fn usable(ray: &Ray, triangle: &Corners) -> bool {
    ray.origin.is_finite()
        && ray.direction.is_finite()
        && triangle.iter().all(|corner| corner.is_finite())
        && !ray.t_min.is_nan()
        && !ray.t_max.is_nan()
}

/// a·(b×c).
fn triple(a: &[BigInt; 3], b: &[BigInt; 3], c: &[BigInt; 3]) -> BigInt {
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
}
