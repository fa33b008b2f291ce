//! `cargo xtask compare`: builds the suite for this machine and runs it.

use std::process::ExitCode;

use crate::native::for_this_machine;
use crate::places::Places;
use crate::setup::Ready;
use crate::shell::{cargo, run_to_end};

/// Runs `rayscale compare ARGS` in the checkout; its exit code is this one's.
pub fn run(places: &Places, ready: &Ready, args: &[String]) -> ExitCode {
    let mut command = cargo();
    command.current_dir(&places.root).args(["run", "--release", "--package", "rayscale"]);
    if !ready.embree {
        command.arg("--no-default-features");
    }
    for_this_machine(&mut command, places).args(["--", "compare"]).args(args);
    run_to_end(&mut command)
}
