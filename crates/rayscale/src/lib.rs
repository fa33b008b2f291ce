//! The harness: scenes, ray sets, structures, checks, measurements, reports.

#![forbid(unsafe_code)]

pub mod cmd;
pub mod near;
pub mod output;
pub mod rays;
pub mod scene;
pub mod units;
