//! What all parts of the fast structure share: its name, and what none of them counts.

/// As errors and the suite call it.
pub const ID: &str = "bmssm";

/// Bytes that rayon takes for tasks, and whatever is counted in no phase of building.
pub const UNCOUNTED: u128 = 8 << 10;
