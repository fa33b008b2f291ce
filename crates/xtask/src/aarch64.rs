//! `cargo xtask aarch64`: the tests of the structures with NEON, by emulation where the processor is another.

use std::process::{Command, ExitCode};

use crate::checks::tests;
use crate::host::apt_install;
use crate::places::{CORE, Places};
use crate::shell::{cargo, output, there_is};
use crate::tally::Tally;

/// Links without a C toolchain for it: Rust brings the C library and the linker.
const TARGET: &str = "aarch64-unknown-linux-musl";
const VARIABLES: &str = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL";
const EMULATOR: &str = "qemu-aarch64-static";

/// Generated cases of each property. Emulation is some thirty times slower.
const CASES: &str = "24";

/// Runs the tests and prints how many passed and failed as the last line.
pub fn run(places: &Places) -> ExitCode {
    let mut tally = Tally::default();
    let done = prepare().and_then(|linker| {
        let mut command = cargo();
        command.current_dir(&places.root).args(["test", "--target", TARGET]);
        command.args(CORE.map(|package| format!("-p{package}")));
        command.env(format!("{VARIABLES}_LINKER"), linker);
        if !cfg!(target_arch = "aarch64") {
            command.env(format!("{VARIABLES}_RUNNER"), EMULATOR);
        }
        command.env(format!("{VARIABLES}_RUSTFLAGS"), "-Clink-self-contained=yes");
        tests(command.env("PROPTEST_CASES", CASES), &mut tally)
    });
    println!("{} passed, {} failed", tally.passed, tally.failed);
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Sees to the target's standard library and the emulator; returns the linker's path.
fn prepare() -> Result<String, String> {
    output(Command::new("rustup").args(["target", "add", TARGET]))?;
    if !cfg!(target_arch = "aarch64") && !there_is(EMULATOR) {
        apt_install(&["qemu-user-static"])?;
    }
    let printed = output(Command::new("rustc").args(["--print", "target-libdir"]))?;
    let tools = std::path::Path::new(printed.trim()).with_file_name("bin");
    let linker = tools.join("rust-lld");
    if !linker.exists() {
        return Err(format!("this Rust has no linker of its own at {}", linker.display()));
    }
    Ok(linker.to_string_lossy().into_owned())
}
