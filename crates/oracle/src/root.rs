//! Roots of quadratic equations, compared and rounded without error.

use std::cmp::Ordering;

use super::integers::common_exponent;
use super::rational::Rational;
use num_bigint::BigInt;
use num_traits::Zero;

/// A root of a quadratic equation in a ray's t: (b ± √D)/a · 2^exponent with a > 0, which is irrational as a rule. It
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
    /// (b − √D)/a · 2^exponent and (b + √D)/a · 2^exponent, for a > 0 and D ≥ 0.
    pub(super) fn both(a: BigInt, b: BigInt, discriminant: BigInt, exponent: i32) -> [Self; 2] {
        let root = |second| Self {
            a: a.clone(),
            b: b.clone(),
            discriminant: discriminant.clone(),
            exponent,
            second,
        };
        [root(false), root(true)]
    }

    /// n/d · 2^exponent for d > 0.
    pub(super) fn quotient(n: BigInt, d: BigInt, exponent: i32) -> Self {
        Self { a: d, b: n, discriminant: BigInt::ZERO, exponent, second: true }
    }

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
