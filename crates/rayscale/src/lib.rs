//! The harness: scenes, ray sets, structures, checks, measurements, reports.

#![forbid(unsafe_code)]

pub use scenes::{self as scene, exchange, near, rays};

pub mod answers;
pub mod auto;
pub mod changes;
pub mod check;
pub mod clock;
pub mod cmd;
pub mod grouped;
pub mod heap;
pub mod machine;
pub mod measure;
pub mod output;
pub mod palette;
pub mod paper;
pub mod picture;
pub mod rayset;
pub mod recommend;
pub mod record;
pub mod registry;
pub mod report;
pub mod stats;
#[cfg(test)]
mod testing;
pub mod trade;
pub mod units;
