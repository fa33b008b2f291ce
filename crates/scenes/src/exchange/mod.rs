//! Rays and hits as CSV, for other programs.

mod hits;
mod rays;

pub use hits::{write_all_hits, write_hits};
pub use rays::{FIELDS, RaysCsvError, read_rays};
