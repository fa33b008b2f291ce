//! What looks for faults: a named tree of groups of checks, random cases from numbers, a long run over them, and the
//! functions that fuzzers call.
//!
//! [`cases`] makes scenes, rays and settings from any source of numbers; [`compare`] holds a structure to brute force and,
//! with the exact kernel, to the oracle. [`marathon`] does that for as long as it is let; [`targets`] does it for bytes,
//! and the same for every reader; [`groups`] asks named questions of every structure; [`kinds`] takes every
//! kind of solid through all of them; [`unusable`] gives them rays that are none, and [`patience`] tells what does not end.

#![forbid(unsafe_code)]

pub mod cases;
pub mod compare;
pub mod groups;
pub mod kinds;
pub mod marathon;
mod numbers;
pub mod patience;
pub mod targets;
pub mod unusable;

pub use numbers::{Bytes, Numbers};
