//! The oracle: ray against triangle without any rounding.
//!
//! Inputs are `f32`, so every quantity is a rational number, and integers decide
//! hit or miss, the order of hits along the ray, and ties. No tolerance appears
//! anywhere. What the oracle calls a hit:
//!
//! - The triangle is **closed**: a ray through an edge or a corner hits it, and it
//!   is hit from either side.
//! - The range of t is closed: a hit exactly at `t_min` or `t_max` counts.
//! - With d·n = 0 there is **no hit**: neither for a ray in the triangle's plane nor
//!   for a triangle without area, which has no plane (n = 0). Every kernel
//!   treats a zero determinant as a miss, and a crossing that is a whole segment
//!   has no single t to report.
//! - The nearest hit wins; of hits at exactly the same t the lowest object number.
//! - A ray or triangle with a NaN or infinite coordinate, a zero direction or a NaN
//!   in its range hits nothing. `t_min` and `t_max` may be infinite.
//!
//! Spheres are closed likewise, and their roots irrational: they are compared and rounded as integers
//! ([`sphere_roots`]). So are those of quadrics, whose boxes are left out of account ([`quadric_roots`]).
//!
//! The signs are those of the products d·(b×a) of the corners relative to the origin:
//! Woop, Benthin, Wald, *Watertight Ray/Corners Intersection*, JCGT 2(1), 2013, §2,
//! before any shearing or rounding.

#![forbid(unsafe_code)]

mod closest;
mod filter;
mod integers;
mod intersect;
mod oracle;
mod quadric;
mod rational;
mod root;
mod sphere;
mod verdict;

#[cfg(test)]
mod naive;
#[cfg(test)]
mod tests;

pub use closest::{closest, closest_unfiltered};
pub use filter::Filter;
pub use intersect::{ExactHit, intersect};
pub use oracle::Oracle;
pub use quadric::{Roots, quadric_roots};
pub use rational::Rational;
pub use root::Root;
pub use sphere::{intersect_sphere, sphere_roots};
pub use verdict::{Judgement, Verdict, classify};
