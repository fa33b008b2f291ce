//! `cargo xtask bench`: the criterion benches, compiled for this machine.

use std::process::ExitCode;

use crate::checks::ADAPTER;
use crate::native::for_this_machine;
use crate::places::Places;
use crate::setup::Ready;
use crate::shell::{cargo, run_to_end};

/// Runs `cargo bench --workspace ARGS`.
pub fn run(places: &Places, ready: &Ready, args: &[String]) -> ExitCode {
    let mut command = cargo();
    command.current_dir(&places.root).args(["bench", "--workspace"]);
    if !ready.embree {
        command.arg("--no-default-features").args(ADAPTER.map(|package| format!("--exclude={package}")));
    }
    run_to_end(for_this_machine(&mut command, places).args(args))
}
