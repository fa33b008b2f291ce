//! The command line as a user meets it.

mod bad_input;
mod bad_scenes;
mod browser;
mod common;
mod diff;
mod frame;
mod interruptions;
mod json;
mod limits;
mod noise;
mod old_records;
mod pictures;
mod places;
mod records;
mod schema;
mod strange_records;
mod trace;
