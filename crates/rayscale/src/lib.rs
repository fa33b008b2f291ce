//! The harness: scenes, ray sets, structures, checks, measurements, reports.

#![forbid(unsafe_code)]

pub mod scene;
