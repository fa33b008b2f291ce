//! Where rays cross solids: one file a kind, each with every crossing in order and the nearest.
//!
//! What the kinds are is in [`accel::solid`].

#![forbid(unsafe_code)]

mod block;
mod cone;
mod crossing;
mod csg;
mod disc;
mod facets;
mod implicit;
mod interval;
mod kind;
mod local;
mod objects;
mod patch;
mod polynomial;
mod quadratic;
mod quadric;
mod sphere;
mod torus;
mod triangle;

pub use crossing::{Crossing, Crossings};
pub use objects::Solids;
