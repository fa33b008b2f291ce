//! What wrong answers do, by exact arithmetic.
//!
//! A structure may report another object than the exact one and nobody sees it: two triangles lie in the same place, or
//! share the edge that the ray meets. It may miss a wall, and everybody does. [`Kind`] keeps these apart, [`Judge`] tells which an
//! answer is, [`Counts`] adds them up with their bounds, and [`Spread`] says how far right answers are off.

#![forbid(unsafe_code)]

mod bounds;
mod counts;
mod examined;
mod judge;
mod kind;
mod limits;
mod spread;
mod surface;
mod tolerance;
mod truth;

#[cfg(test)]
mod tests;

pub use bounds::Bounds;
pub use counts::{Counted, Counts};
pub use examined::Examined;
pub use judge::{Judge, Judgement, Tally};
pub use kind::Kind;
pub use limits::Limits;
pub use spread::{Errors, Spread};
pub use tolerance::Tolerance;
pub use truth::{TrueHit, Truth};
