//! `cargo xtask compare`: builds the suite and runs it.

use std::process::ExitCode;

use crate::places::Places;
use crate::setup::Ready;
use crate::shell::cargo;

/// Runs `rayscale compare ARGS` in the checkout; its exit code is this one's.
pub fn run(places: &Places, ready: &Ready, args: &[String]) -> ExitCode {
    let mut command = cargo();
    command.current_dir(&places.root).args(["run", "--release", "--package", "rayscale"]);
    if !ready.embree {
        command.arg("--no-default-features");
    }
    command.args(["--", "compare"]).args(args);
    match command.status() {
        Ok(status) => {
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            ExitCode::from(code.unwrap_or(1))
        }
        Err(e) => {
            eprintln!("xtask: cargo cannot be run: {e}");
            ExitCode::FAILURE
        }
    }
}
