//! The fast structure's name.

/// As errors and the suite call it.
pub const ID: &str = "bmssm";
