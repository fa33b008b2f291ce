//! Reports, made from a record alone.

mod csv;
pub mod html;
mod markdown;
mod memory;
mod pictures;
mod splice;
pub mod table;
#[cfg(test)]
mod tests;

pub use csv::write_csv;
pub use markdown::markdown;
pub use pictures::pictures;
pub use splice::{BEGIN, END, SpliceError, splice, summary};
