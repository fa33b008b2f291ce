//! Where rays cross solids: one file a kind, each with every crossing in order and the nearest.
//!
//! What the kinds are is in [`accel::solid`].

#![forbid(unsafe_code)]

mod block;
mod cone;
mod crossing;
mod disc;
mod kind;
mod local;
mod objects;
mod polynomial;
mod quadratic;
mod quadric;
mod sphere;
mod torus;
mod triangle;

pub use crossing::{Crossing, Crossings};
pub use objects::Solids;
