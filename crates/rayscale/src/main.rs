//! The command line of the suite.

#![forbid(unsafe_code)]

mod cli;
mod console;
mod error;
mod interrupt;
mod options;
mod progress;
mod verb;
mod verbs;

use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: heap::Counting = heap::Counting;

fn main() -> ExitCode {
    heap::start_counting();
    cli::main()
}
