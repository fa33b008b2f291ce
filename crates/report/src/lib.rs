//! Reports, made from a record alone.
//!
//! [`table`] and [`chart`] are the one table and the one chart of the suite; [`markdown`], [`mod@html`] and [`trade`] fill
//! them from what was measured. [`picture`] turns hits into pixels.

#![forbid(unsafe_code)]

mod aggregate;
pub mod cells;
pub mod chart;
mod charts;
pub mod html;
mod markdown;
mod memory;
pub mod picture;
mod splice;
pub mod table;
#[cfg(test)]
mod tests;
pub mod trade;

pub use markdown::markdown;
pub use splice::{BEGIN, END, EXTREMES, SpliceError, TRADE, splice, splice_at, summary};
