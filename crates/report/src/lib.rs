//! Reports, made from a record alone: tables, charts, pages. [`picture`] turns hits into pixels.

#![forbid(unsafe_code)]

mod csv;
pub mod html;
mod markdown;
mod memory;
pub mod palette;
pub mod picture;
mod splice;
pub mod table;
#[cfg(test)]
mod tests;
pub mod trade;

pub use csv::write_csv;
pub use markdown::markdown;
pub use splice::{BEGIN, END, SpliceError, splice, summary};
