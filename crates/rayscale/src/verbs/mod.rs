//! The verbs, one file each.

pub mod check;
pub mod cmp;
pub mod compare;
pub mod completions;
pub mod diff;
mod hits;
pub mod measure;
pub mod paper;
mod pictures;
pub mod rank;
pub mod recommend;
pub mod render;
pub mod report;
pub mod scenes;
pub mod structures;
pub mod trace;
pub mod trade;
pub mod welcome;
