//! t without error, as a quotient of two exact sums.

use accel::expansion::{Expansion, sign, triple};
use accel::{Corners, Ray};
use std::cmp::Ordering;

/// Terms of a scaled t: four triple products of six products in two parts each.
const T_TERMS: usize = 48;

/// Terms of a determinant: three such triple products.
const DET_TERMS: usize = 36;

/// A scaled t less a multiple of a determinant.
const DIFFERENCE_TERMS: usize = T_TERMS + 2 * DET_TERMS;

/// Parts that don't overlap, and none of which touches the next (as they don't where sums round ties to even), of
/// multiples of 2^-894 below 2^780.
const CROSS_TERMS: usize = (894 + 780) / 2 + 1;

/// Above the relative error of a quotient of two estimates.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// Where a ray meets a triangle's plane: t, and the weights of the second and third corner.
pub(super) struct Quotient {
    t: Expansion<T_TERMS>,
    det: Expansion<DET_TERMS>,
    weights: [Expansion<DET_TERMS>; 2],
}

impl Quotient {
    /// That of the ray's line, whatever its range; `None` if it is parallel to the plane or there is none.
    pub(super) fn of(ray: &Ray, [a, b, c]: &Corners) -> Option<Self> {
        let (o, d) = (ray.origin, ray.direction);
        let mut det = Expansion::ZERO;
        // d·((a−o)×(c−o)) + d·((b−o)×(a−o)) + d·((c−o)×(b−o)), in which the products with o cancel out.
        triple(&mut det, d, *a, *c);
        triple(&mut det, d, *b, *a);
        triple(&mut det, d, *c, *b);
        if det.sign().is_eq() {
            return None;
        }
        let mut t = Expansion::ZERO;
        // (a−o)·((c−o)×(b−o)), in which products with two o vanish.
        triple(&mut t, *a, *c, *b);
        triple(&mut t, -o, *c, *b);
        triple(&mut t, *a, -o, *b);
        triple(&mut t, *a, *c, -o);
        let weights = [(a, c), (b, a)].map(|(p, q)| {
            let mut weight = Expansion::ZERO;
            // d·((p−o)×(q−o))
            triple(&mut weight, d, *p, *q);
            triple(&mut weight, d, *p, -o);
            triple(&mut weight, d, -o, *q);
            weight
        });
        Some(Self { t, det, weights })
    }

    /// t, correctly rounded, and the weights, rounded; zeros are positive.
    pub(super) fn rounded(&self) -> [f32; 3] {
        let det = self.det.estimate();
        let [u, v] =
            [&self.weights[0], &self.weights[1]].map(|weight| (weight.estimate() / det) as f32 + 0.0);
        [self.rounded_t() + 0.0, u, v]
    }

    fn rounded_t(&self) -> f32 {
        let estimate = self.t.estimate() / self.det.estimate();
        let (a, b) = ((estimate * (1.0 - SLACK)) as f32, (estimate * (1.0 + SLACK)) as f32);
        if a == b {
            return a;
        }
        // Two neighbours. What is infinite stands for the next power of two.
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let wide = |x: f32| if x.is_infinite() { 2f64.powi(128).copysign(x.into()) } else { x.into() };
        match self.compare_finite((wide(low) + wide(high)) / 2.0) {
            Ordering::Less => low,
            Ordering::Greater => high,
            Ordering::Equal if low.to_bits() & 1 == 0 => low,
            Ordering::Equal => high,
        }
    }

    /// How t compares with a number that isn't NaN.
    pub(super) fn compare(&self, value: f32) -> Ordering {
        if value.is_infinite() {
            return sign(-f64::from(value));
        }
        self.compare_finite(value.into())
    }

    /// How t compares with a number of 25 digits or fewer.
    fn compare_finite(&self, value: f64) -> Ordering {
        let estimate = self.t.estimate() / self.det.estimate();
        if (estimate - value).abs() > estimate.abs() * SLACK {
            return sign(estimate - value);
        }
        let mut difference = Expansion::<DIFFERENCE_TERMS>::ZERO;
        difference.add_multiple(1.0, &self.t);
        difference.add_multiple(-value, &self.det);
        turned(difference.sign(), self.det.sign())
    }

    /// How t compares with that of another triangle.
    pub(super) fn cmp(&self, other: &Self) -> Ordering {
        let (a, b) = (self.t.estimate() / self.det.estimate(), other.t.estimate() / other.det.estimate());
        if (a - b).abs() > (a.abs() + b.abs()) * SLACK {
            return sign(a - b);
        }
        let mut difference = Expansion::<CROSS_TERMS>::ZERO;
        for part in self.t.parts() {
            difference.add_multiple(*part, &other.det);
        }
        for part in other.t.parts() {
            difference.add_multiple(-*part, &self.det);
        }
        turned(turned(difference.sign(), self.det.sign()), other.det.sign())
    }
}

/// The sign of a quotient from those of its parts.
fn turned(numerator: Ordering, denominator: Ordering) -> Ordering {
    if denominator.is_lt() { numerator.reverse() } else { numerator }
}
