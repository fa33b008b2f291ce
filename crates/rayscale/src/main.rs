//! The command line of the suite.

mod counting_allocator;

use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: counting_allocator::Counting = counting_allocator::Counting;

fn main() -> ExitCode {
    rayscale::heap::start_counting();
    rayscale::cmd::main()
}
