//! What `f64` knows of the place where a ray meets a triangle's plane.
//!
//! The bounds are those of [`super::reject`] with ε = 2^-53; products of three `f32` neither under- nor overflow.

use crate::kernel::wide::Products;

const BOUND: f64 = 64.0 * f64::EPSILON / 2.0;

/// Of the sum of the sizes of the six products that scaled t is made of: each has eight roundings.
const T_BOUND: f64 = 16.0 * f64::EPSILON / 2.0;

/// t within bounds that are rounded to `f32`, and the weights.
pub(super) struct Meeting {
    /// The true t, rounded, is this or more.
    pub low: f32,
    /// The true t, rounded, is this or less.
    pub high: f32,
    /// The weight of the second corner.
    pub u: f32,
    /// The weight of the third corner.
    pub v: f32,
    /// Whether the determinant is so far from zero that t is within its bounds.
    pub firm: bool,
    /// Whether t is zero without error.
    pub starts_on: bool,
}

/// By how much the determinant and scaled u and v are off at most.
#[inline(always)]
pub(super) fn error_of(products: &Products) -> f64 {
    let Products { edges, from_a, direction, .. } = products;
    let length = greater(largest(edges[0]), largest(edges[1]));
    let size = from_a[0].abs() + from_a[1].abs() + from_a[2].abs() + length;
    length * size * BOUND * largest(*direction)
}

impl Meeting {
    /// `error` is that of [`error_of`].
    #[inline(always)]
    pub(super) fn of(products: &Products, error: f64) -> Self {
        let Products { edges, from_a, det, scaled: [u, v, t], .. } = *products;
        let t_size = volume_of_sizes(edges[1], from_a, edges[0]);
        let t_error = t_size * T_BOUND;
        let reciprocal = 1.0 / det;
        let quotient = t * reciprocal;
        // |t/d − t'/d'| ≤ (error of t' + |t'/d'|·error of d')/|d| with |d| ≥ |d'| − error. The factor makes up for
        // dividing by |d'| where the determinant is firm; the last term for the roundings of the quotient.
        let off = (t_error + quotient.abs() * error) * reciprocal.abs() * 1.001
            + quotient.abs() * (4.0 * f64::EPSILON);
        Self {
            // Adding zero makes −0 a +0.
            low: (quotient - off) as f32 + 0.0,
            high: (quotient + off) as f32 + 0.0,
            u: (u * reciprocal) as f32,
            v: (v * reciprocal) as f32,
            firm: error * 2048.0 < det.abs(),
            // Without any product, as where origin and corners have one coordinate in common.
            starts_on: t_size == 0.0,
        }
    }
}

// As comparisons, for `f64::min` and `max` treat NaN at the cost of more instructions.

/// The sum of the sizes of the products that the determinant of three vectors is made of.
#[inline(always)]
fn volume_of_sizes(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let part = |i: usize, j: usize, k: usize| (a[i] * (b[j] * c[k])).abs() + (a[i] * (b[k] * c[j])).abs();
    part(0, 1, 2) + part(1, 2, 0) + part(2, 0, 1)
}

#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The greatest of three.
#[inline(always)]
pub(super) fn greatest3(a: f64, b: f64, c: f64) -> f64 {
    greater(greater(a, b), c)
}

/// The least of three.
#[inline(always)]
pub(super) fn least3(a: f64, b: f64, c: f64) -> f64 {
    -greatest3(-a, -b, -c)
}

#[inline(always)]
fn largest(v: [f64; 3]) -> f64 {
    greatest3(v[0].abs(), v[1].abs(), v[2].abs())
}
