//! Sums of `f64` values without error.
//!
//! A sum is kept as an expansion: a list of `f64` values that don't overlap and whose sum is exact (J. R. Shewchuk,
//! *Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates*, Discrete & Computational
//! Geometry 18(3), 1997, §2). It is for numbers whose products neither under- nor overflow: here products of at most
//! six `f32`, which are multiples of 2^-894 below 2^780.

use crate::Vec3;
use std::cmp::Ordering;

/// An exact sum of at most `N` values, its parts by ascending size and none zero.
pub struct Expansion<const N: usize> {
    parts: [f64; N],
    len: usize,
}

impl<const N: usize> Expansion<N> {
    /// The empty sum.
    pub const ZERO: Self = Self { parts: [0.0; N], len: 0 };

    /// Adds a number (Shewchuk, Grow-Expansion with zero elimination).
    ///
    /// # Panics
    /// If the sum needs more than `N` parts.
    pub fn add(&mut self, term: f64) {
        if term == 0.0 {
            return;
        }
        let (mut rest, mut len) = (term, 0);
        for i in 0..self.len {
            let (high, low) = two_sum(rest, self.parts[i]);
            if low != 0.0 {
                self.parts[len] = low;
                len += 1;
            }
            rest = high;
        }
        if rest != 0.0 {
            self.parts[len] = rest;
            len += 1;
        }
        self.len = len;
    }

    /// Adds x·y.
    ///
    /// # Panics
    /// If the sum needs more than `N` parts.
    pub fn add_product(&mut self, x: f64, y: f64) {
        if x == 0.0 || y == 0.0 {
            return;
        }
        let (high, low) = two_product(x, y);
        self.add(low);
        self.add(high);
    }

    /// Adds x·`other`.
    ///
    /// # Panics
    /// If the sum needs more than `N` parts.
    pub fn add_multiple<const M: usize>(&mut self, x: f64, other: &Expansion<M>) {
        for part in other.parts() {
            self.add_product(x, *part);
        }
    }

    /// The parts, by ascending size.
    pub fn parts(&self) -> &[f64] {
        &self.parts[..self.len]
    }

    /// The largest part outweighs the others.
    pub fn sign(&self) -> Ordering {
        self.parts().last().map_or(Ordering::Equal, |part| sign(*part))
    }

    /// The sum, off by less than one part in 2^51.
    pub fn estimate(&self) -> f64 {
        self.parts().iter().sum()
    }
}

/// The axes of the three minors of a triple product, each after that of its factor.
pub const MINORS: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// Adds a·(b×c), each of six products of `f32` in two parts.
///
/// # Panics
/// If the sum needs more than `N` parts.
pub fn triple<const N: usize>(sum: &mut Expansion<N>, a: Vec3, b: Vec3, c: Vec3) {
    for [i, j, k] in MINORS {
        for (x, y, z) in [(a[i], b[j], c[k]), (-a[i], b[k], c[j])] {
            // The product of two is exact.
            sum.add_product(f64::from(x), f64::from(y) * f64::from(z));
        }
    }
}

/// How a number compares with zero.
pub fn sign(value: f64) -> Ordering {
    if value > 0.0 {
        Ordering::Greater
    } else if value < 0.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// a + b and its rounding error (Knuth).
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// a·b and its rounding error (Dekker).
#[inline]
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    (product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2))
}

/// A number as a sum of two of 26 digits each (Veltkamp).
#[inline]
fn halves(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_cancel_without_error() {
        let mut sum = Expansion::<8>::ZERO;
        [1e30, -1.0, 1e-30, -1e30, 1.0].into_iter().for_each(|term| sum.add(term));
        assert_eq!((sum.sign(), sum.parts()), (Ordering::Greater, &[1e-30][..]));
        sum.add(-1e-30);
        assert_eq!((sum.sign(), sum.estimate()), (Ordering::Equal, 0.0));
    }

    #[test]
    fn multiples_of_sums_are_exact() {
        let mut thirds = Expansion::<4>::ZERO;
        [1e20, 1.0, 2f64.powi(-40)].into_iter().for_each(|term| thirds.add(term));
        let mut sum = Expansion::<16>::ZERO;
        sum.add_multiple(3.0, &thirds);
        for _ in 0..3 {
            [-1e20, -1.0, -2f64.powi(-40)].into_iter().for_each(|term| sum.add(term));
        }
        assert_eq!(sum.sign(), Ordering::Equal);
        sum.add_multiple(-1.0, &thirds);
        assert_eq!(sum.estimate(), -1e20);
    }
}
