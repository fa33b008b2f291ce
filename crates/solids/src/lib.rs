//! Where rays cross solids: one file a kind, each with every crossing in order and the nearest.
//!
//! What the kinds are is in [`accel::solid`].

#![forbid(unsafe_code)]

mod block;
mod blocks;
mod cone;
mod crossing;
mod csg;
mod disc;
pub mod exact;
mod exact_blocks;
mod exact_pairs;
mod facets;
mod frame;
mod group;
mod hierarchy;
mod implicit;
mod interval;
mod kind;
mod local;
mod objects;
mod paired;
mod pairs;
mod patch;
mod polynomial;
mod quadratic;
mod quadric;
mod rows;
mod sphere;
#[cfg(test)]
mod tests;
mod torus;
mod triangle;

pub use blocks::SolidBlocks;
pub use crossing::{Crossing, Crossings};
pub use objects::Solids;
