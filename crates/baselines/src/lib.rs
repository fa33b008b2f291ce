//! Structures that are none: the reference for hits, and the paper's two reference
//! methods for time.

mod bounding;
mod brute;

pub use bounding::{MinMax, Sphere};
pub use brute::Brute;
