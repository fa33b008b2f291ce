//! The command line as a user meets it.

mod bad_input;
mod browser;
mod common;
mod diff;
mod frame;
mod interruptions;
mod json;
mod noise;
mod pictures;
mod records;
mod schema;
mod trace;
