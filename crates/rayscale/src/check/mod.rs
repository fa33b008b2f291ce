//! Whether structures lose or invent hits, and whether kernels keep what they promise.

mod errors;
pub mod leaks;
pub mod oracle;
mod reference;
pub mod sweep;
#[cfg(test)]
mod tests;

pub use errors::{judge, oracle_of};
pub use reference::{Reference, compare};
