//! The BVH2 and the CWBVH of the crate [obvhs](https://docs.rs/obvhs) behind `accel::Accel`.
//!
//! Triangles are tested by obvhs' own test, on its own 64-byte triangles or its compressed ones, laid out in the order of
//! the tree's leaves; boxes by the suite's test, where they lie. What obvhs does otherwise than the
//! contract asks shows in the accuracy report and not here: the end of a ray's range is open, ties
//! go to the object met first, and components of a direction below 1.2e-7 are clamped in its box
//! tests; the CWBVH can lose objects whose box is flat on an axis.
#![forbid(unsafe_code)]

mod leaves;
mod structure;
mod tree;

pub use structure::{ObvhsBuilder, Preset, Variant};

/// The version of obvhs that the workspace pins.
pub const VERSION: &str = "0.4.0";

#[cfg(test)]
mod tests {
    #[test]
    fn the_version_is_the_one_pinned() {
        let manifest = include_str!("../../../../Cargo.toml");
        assert!(manifest.contains(&format!("obvhs = \"={}\"", super::VERSION)));
    }
}
