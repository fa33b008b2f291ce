//! Certain misses, told in `f64` with a proven bound, so that integers need only
//! look at what is left.
//!
//! **The bound.** Let ε = 2^-53. Coordinates are `f32`, so every product of three
//! differences is a multiple of 2^-447 below 2^385: nothing under- or overflows in `f64`, and
//! every operation is exact up to a factor 1 + δ, |δ| ≤ ε. A corner relative to the
//! origin takes one such factor per coordinate. In d·(a×c), each of the six products
//! takes at most 7 (two differences, two multiplications, three additions), in a·(c×b) at most 8,
//! so the computed sum is off by at most 8ε/(1 − 8ε)·M, M being the sum of the six
//! absolute products. M is computed too, low by at most the factor (1 − ε)^8. The
//! sum u + v + w adds two roundings of at most ε·(Mu + Mv + Mw)·(1 + 8ε) each. Ten ε
//! and a few ε² suffice in every case; [`BOUND`] is 16ε.

use super::intersect::usable;
use accel::{Corners, Ray, Vec3};

/// Relative to the sum of the absolute products: above any error, see the module.
const BOUND: f64 = 16.0 * f64::EPSILON / 2.0;

/// Below this |t| a limit is raised to it, so that limit·det can't underflow.
const MIN_LIMIT: f64 = 1e-60;

/// A test of one ray against triangles that rejects only what is certainly missed.
#[derive(Clone, Copy, Debug)]
pub struct Filter {
    ray: Ray,
    direction: [f64; 3],
}

/// A computed value and the most it can be off.
#[derive(Clone, Copy)]
struct Bounded {
    value: f64,
    error: f64,
}

impl Filter {
    /// A filter for `ray`.
    pub fn new(ray: &Ray) -> Self {
        Self { ray: *ray, direction: wide(ray.direction) }
    }

    /// Whether the closed `triangle` is certainly not hit at a t in
    /// [`t_min`, min(`t_max`, `t_limit`)]. `false` says nothing.
    pub fn rejects(&self, triangle: &Corners, t_limit: f64) -> bool {
        if !usable(&self.ray, triangle) {
            return true;
        }
        let o = wide(self.ray.origin);
        let [a, b, c] = triangle.map(|corner| {
            let p = wide(corner);
            [p[0] - o[0], p[1] - o[1], p[2] - o[2]]
        });
        let d = self.direction;
        let (u, v, w) = (triple(d, a, c), triple(d, b, a), triple(d, c, b));
        let plus = |x: Bounded| x.value > x.error;
        let minus = |x: Bounded| x.value < -x.error;
        if (plus(u) || plus(v) || plus(w)) && (minus(u) || minus(v) || minus(w)) {
            return true;
        }
        let det = Bounded { value: u.value + v.value + w.value, error: u.error + v.error + w.error };
        if !plus(det) && !minus(det) {
            return false;
        }
        let sign = det.value.signum();
        let det = Bounded { value: sign * det.value, ..det };
        let scaled_t = triple(a, c, b);
        let scaled_t = Bounded { value: sign * scaled_t.value, ..scaled_t };
        let limit = t_limit.min(f64::from(self.ray.t_max));
        let limit = if limit.abs() < MIN_LIMIT { MIN_LIMIT } else { limit };
        let least = f64::from(self.ray.t_min);
        certainly_above(scaled_t, limit, det)
            || certainly_above(Bounded { value: -scaled_t.value, ..scaled_t }, -least, det)
    }
}

/// Whether x > factor·det for certain; det is certainly positive.
fn certainly_above(x: Bounded, factor: f64, det: Bounded) -> bool {
    let right = factor * det.value;
    // Four roundings: of the product, the two margins and the difference.
    let margin = x.error + factor.abs() * det.error;
    let rounding = (x.value.abs() + right.abs() + margin) * (2.0 * f64::EPSILON);
    // An infinite factor makes this NaN or −∞, so: not certain.
    x.value - right > margin + rounding
}

/// a·(b×c) with its error bound.
fn triple(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Bounded {
    let mut value = 0.0;
    let mut magnitude = 0.0;
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let (p, q) = (b[j] * c[k], b[k] * c[j]);
        value += a[i] * (p - q);
        magnitude += a[i].abs() * (p.abs() + q.abs());
    }
    Bounded { value, error: magnitude * BOUND }
}

fn wide(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}
