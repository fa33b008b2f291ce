//! Triple products a·(b × c).

use super::expansion::Expansion;
use accel::Vec3;

/// The axes of the three minors of a triple product, each after that of its factor.
pub(super) const MINORS: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// Adds a·(b×c), each of six products of `f32` in two parts.
pub(super) fn triple<const N: usize>(sum: &mut Expansion<N>, a: Vec3, b: Vec3, c: Vec3) {
    for [i, j, k] in MINORS {
        for (x, y, z) in [(a[i], b[j], c[k]), (-a[i], b[k], c[j])] {
            // The product of two is exact.
            sum.add_product(f64::from(x), f64::from(y) * f64::from(z));
        }
    }
}
