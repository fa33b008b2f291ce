//! The same answers by reduced fractions and Cramer's rule, written apart from the
//! oracle to check it.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use accel::{Corners, Ray, Vec3};

type Point = [BigRational; 3];

fn point(v: Vec3) -> Point {
    v.to_array().map(|x| BigRational::from_float(x).expect("finite"))
}

fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|i| &a[i] - &b[i])
}

/// Determinant of three columns by expansion along the first row.
fn determinant(x: &Point, y: &Point, z: &Point) -> BigRational {
    let minor = |p: &Point, q: &Point| &p[1] * &q[2] - &p[2] * &q[1];
    &x[0] * minor(y, z) - &y[0] * minor(x, z) + &z[0] * minor(x, y)
}

/// (t, u, v) of the hit: the solution of u·e1 + v·e2 − t·d = o − v0 if it has exactly
/// one and that lies in the closed triangle and range.
pub(super) fn intersect(ray: &Ray, triangle: &Corners) -> Option<[BigRational; 3]> {
    let [v0, v1, v2] = triangle.map(point);
    let (e1, e2) = (minus(&v1, &v0), minus(&v2, &v0));
    let back = point(ray.direction).map(|x| -x);
    let s = minus(&point(ray.origin), &v0);
    let whole = determinant(&e1, &e2, &back);
    if whole.is_zero() {
        return None;
    }
    let u = determinant(&s, &e2, &back) / &whole;
    let v = determinant(&e1, &s, &back) / &whole;
    let t = determinant(&e1, &e2, &s) / &whole;
    let inside = !u.is_negative() && !v.is_negative() && &u + &v <= BigRational::one();
    let after =
        ray.t_min == f32::NEG_INFINITY || (ray.t_min.is_finite() && t >= BigRational::from_float(ray.t_min)?);
    let before =
        ray.t_max == f32::INFINITY || (ray.t_max.is_finite() && t <= BigRational::from_float(ray.t_max)?);
    (inside && after && before).then_some([t, u, v])
}
