//! A rational number that compares exactly and rounds correctly.

use num_bigint::{BigInt, BigUint, Sign};
use num_traits::{Signed, Zero};
use std::cmp::Ordering;

use super::integers::split;

/// numerator / denominator · 2^exponent with a positive denominator, not reduced:
/// comparison multiplies crosswise.
#[derive(Clone, Debug)]
pub struct Rational {
    numerator: BigInt,
    denominator: BigInt,
    exponent: i32,
}

impl Rational {
    /// numerator / denominator · 2^exponent.
    ///
    /// # Panics
    /// If `denominator` is zero.
    pub fn new(numerator: BigInt, denominator: BigInt, exponent: i32) -> Self {
        assert!(!denominator.is_zero(), "a rational number needs a denominator");
        if denominator.is_negative() {
            return Self { numerator: -numerator, denominator: -denominator, exponent };
        }
        Self { numerator, denominator, exponent }
    }

    /// Numerator, with the sign.
    pub fn numerator(&self) -> &BigInt {
        &self.numerator
    }

    /// Denominator, positive.
    pub fn denominator(&self) -> &BigInt {
        &self.denominator
    }

    /// The power of two that the fraction is multiplied by.
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// Where this number lies relative to `value`; infinities are beyond every
    /// rational. `None` for NaN.
    pub fn compare(&self, value: f32) -> Option<Ordering> {
        if value.is_nan() {
            return None;
        }
        if value.is_infinite() {
            return Some(if value > 0.0 { Ordering::Less } else { Ordering::Greater });
        }
        Some(self.cmp(&Self::from(value)))
    }

    /// The nearest `f32`, ties to even; beyond the largest finite one an infinity.
    /// A zero is +0, whatever the sign of
    /// the number.
    pub fn to_f32(&self) -> f32 {
        self.round(24, -149, 127) as f32
    }

    /// The nearest `f64`, ties to even; beyond the largest finite one an infinity.
    pub fn to_f64(&self) -> f64 {
        self.round(53, -1074, 1023)
    }

    /// `reported` − this number, in units of the spacing of `f32` at this number
    /// (2^-149 at and near zero). NaN stays NaN, an infinity is infinitely far.
    pub fn ulp_error(&self, reported: f32) -> f64 {
        if !reported.is_finite() {
            return f64::from(reported);
        }
        let ulp = self.floor_log2().map_or(-149, |k| (k - 23).max(-149));
        let mut error = Self::from(reported) - self;
        error.exponent -= ulp as i32;
        error.to_f64()
    }

    /// floor(log2 |self|), `None` for zero.
    fn floor_log2(&self) -> Option<i64> {
        if self.numerator.is_zero() {
            return None;
        }
        let (n, d) = (self.numerator.magnitude(), self.denominator.magnitude());
        // 2^(k-1) < n/d < 2^(k+1)
        let k = n.bits() as i64 - d.bits() as i64;
        let reaches = if k >= 0 { *n >= (d << k) } else { (n << -k) >= *d };
        Some(k - i64::from(!reaches) + i64::from(self.exponent))
    }

    /// Rounds to `precision` bits, no bit below 2^least, no value of exponent above
    /// `greatest`. All such numbers are exact in `f64`.
    fn round(&self, precision: i64, least: i64, greatest: i64) -> f64 {
        let Some(log2) = self.floor_log2() else {
            return 0.0;
        };
        if log2 > greatest {
            return if self.numerator.is_negative() { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        let unit = (log2 - precision + 1).max(least);
        // n/d·2^exponent in units of 2^unit.
        let shift = i64::from(self.exponent) - unit;
        let (mut n, mut d) = (self.numerator.magnitude().clone(), self.denominator.magnitude().clone());
        if shift >= 0 {
            n <<= shift;
        } else {
            d <<= -shift;
        }
        let mut quotient = &n / &d;
        let twice_rest: BigUint = (n - &quotient * &d) << 1;
        let odd = quotient.bit(0);
        if twice_rest > d || (twice_rest == d && odd) {
            quotient += 1u32;
        }
        // At most 2^precision, so exact as u64 and as f64.
        let digits = u64::try_from(&quotient).unwrap_or(u64::MAX) as f64;
        // Two steps, for 2^unit itself may lie below the least normal f64.
        let magnitude = digits * 2f64.powi((unit / 2) as i32) * 2f64.powi((unit - unit / 2) as i32);
        let magnitude = if magnitude >= 2f64.powi(greatest as i32) * 2.0 { f64::INFINITY } else { magnitude };
        if self.numerator.sign() == Sign::Minus && magnitude > 0.0 { -magnitude } else { magnitude }
    }

    /// Numerators of both over the same denominator and exponent.
    fn aligned(&self, other: &Self) -> (BigInt, BigInt) {
        let a = &self.numerator * &other.denominator;
        let b = &other.numerator * &self.denominator;
        match self.exponent - other.exponent {
            0 => (a, b),
            by if by > 0 => (a << by, b),
            by => (a, b << -by),
        }
    }
}

impl From<f32> for Rational {
    /// The exact value.
    ///
    /// # Panics
    /// For NaN and infinities.
    fn from(value: f32) -> Self {
        assert!(value.is_finite(), "{value} is not a rational number");
        let (m, e) = split(value);
        Self::new(BigInt::from(m), BigInt::from(1), e)
    }
}

impl std::ops::Sub<&Self> for Rational {
    type Output = Self;

    fn sub(self, other: &Self) -> Self {
        let (a, b) = self.aligned(other);
        let exponent = self.exponent.min(other.exponent);
        Self::new(a - b, &self.denominator * &other.denominator, exponent)
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        let signs = self.numerator.sign().cmp(&other.numerator.sign());
        if signs.is_ne() {
            return signs;
        }
        let (a, b) = self.aligned(other);
        a.cmp(&b)
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Rational {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Rational {}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ratio(n: i64, d: i64, e: i32) -> Rational {
        Rational::new(BigInt::from(n), BigInt::from(d), e)
    }

    #[test]
    fn rounding_at_the_edges_of_the_range() {
        assert_eq!(ratio(1, 3, 0).to_f32(), 1.0 / 3.0);
        assert_eq!(ratio(-1, -3, 0), ratio(2, 3, -1));
        assert_eq!(ratio(0, -3, 7).to_f32().to_bits(), 0);
        // Half of the least denormal is a tie to even zero; a little more is not.
        assert_eq!(ratio(1, 1, -150).to_f32(), 0.0);
        assert_eq!(ratio(3, 1, -151).to_f32(), f32::from_bits(1));
        // Half a unit above the largest finite number goes to infinity.
        assert_eq!(ratio(0x1ff_ffff, 1, 103).to_f32(), f32::INFINITY);
        assert_eq!(ratio(-0x1ff_fffe, 1, 103).to_f32(), f32::MIN);
        assert_eq!(ratio(1, 1, 5000).to_f32(), f32::INFINITY);
        assert_eq!(ratio(-1, 1, -5000).to_f32().to_bits(), 0);
        // Ties to even.
        assert_eq!(ratio(0x100_0001, 1, 0).to_f32(), 16_777_216.0);
        assert_eq!(ratio(0x100_0003, 1, 0).to_f32(), 16_777_220.0);
    }

    #[test]
    fn errors_in_ulps_have_a_sign() {
        let third = ratio(1, 3, 0);
        let nearest = third.to_f32();
        assert!((third.ulp_error(nearest) - 1.0 / 3.0).abs() < 1e-9);
        assert!((third.ulp_error(nearest.next_down()) + 2.0 / 3.0).abs() < 1e-9);
        assert_eq!(ratio(0, 1, 0).ulp_error(f32::from_bits(2)), 2.0);
        assert_eq!(ratio(1, 1, 0).ulp_error(1f32.next_up()), 1.0);
        assert!(third.ulp_error(f32::NAN).is_nan());
    }

    #[test]
    fn infinities_are_beyond_and_nan_is_nowhere() {
        let big = ratio(1, 1, 4000);
        assert_eq!(big.compare(f32::INFINITY), Some(Ordering::Less));
        assert_eq!(big.compare(f32::NEG_INFINITY), Some(Ordering::Greater));
        assert_eq!(big.compare(f32::NAN), None);
    }

    proptest! {
        #[test]
        fn quotients_of_floats_round_as_the_processor_does(a: i32, b in 1i32.., e in -180i32..140) {
            // f64 quotients of 32-bit integers never lie so near a tie of f64
            // that the second rounding could go wrong for f64 itself.
            let exact = ratio(a.into(), b.into(), 0);
            prop_assert_eq!(exact.to_f64(), f64::from(a) / f64::from(b));
            let (x, y) = (a as f32, b as f32);
            let f = Rational::from(x);
            let g = Rational::from(y);
            let quotient = Rational::new(f.numerator() * g.denominator(), g.numerator().clone(), f.exponent() - g.exponent());
            prop_assert_eq!(quotient.to_f32(), x / y);
            // Powers of two only move the exponent, but for denormals.
            let scaled = ratio(a.into(), 1, e);
            prop_assert_eq!(scaled.to_f32(), (f64::from(a) * 2f64.powi(e)) as f32);
        }

        #[test]
        fn order_is_the_order_of_floats(a: f32, b: f32) {
            prop_assume!(a.is_finite() && b.is_finite());
            prop_assert_eq!(Rational::from(a).partial_cmp(&Rational::from(b)), a.partial_cmp(&b));
            prop_assert_eq!(Rational::from(a).to_f32(), a);
            prop_assert_eq!(Rational::from(a).compare(b), a.partial_cmp(&b));
        }
    }
}
