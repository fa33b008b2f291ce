//! Whether structures lose or invent hits.

mod errors;
mod reference;
pub mod sweep;
#[cfg(test)]
mod tests;

pub use errors::judge;
pub use reference::{Reference, compare};
