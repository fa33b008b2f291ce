//! `cargo xtask sanitize`: the tests of the crates with `unsafe` in them under address and thread sanitizers and miri.

use std::process::{Command, ExitCode};

use crate::places::Places;
use crate::shell::{cargo, nightly, output, run_to_end};

/// The crates that hold `unsafe`, or run what does: instructions, and no C++.
const CRATES: [&str; 5] =
    ["rayscale-lanes", "rayscale-primitives", "rayscale-baselines", "bmssm", "rayscale-ssm"];

/// The crate with `unsafe` in it whose tests miri can run: it knows no vector instructions, so of lanes it sees plain Rust, and
/// nothing of Embree.
const FOR_MIRI: &str = "rayscale-lanes";

/// A way to run the tests, and what of nightly Rust it needs besides the compiler.
struct Tool {
    name: &'static str,
    component: &'static str,
    command: fn(&str) -> Command,
}

const TOOLS: [Tool; 3] = [
    Tool { name: "address", component: "rust-src", command: |triple| sanitized("address", triple) },
    Tool { name: "thread", component: "rust-src", command: |triple| sanitized("thread", triple) },
    Tool { name: "miri", component: "miri", command: |_| miri() },
];

fn sanitized(sanitizer: &str, triple: &str) -> Command {
    let mut command = nightly();
    // The standard library too is built for it, or threads of it would be taken for racing.
    command.args(["test", "-Zbuild-std", "--target", triple, "--lib", "--tests"]);
    command.args(CRATES.map(|package| format!("-p{package}")));
    command.env("RUSTFLAGS", format!("-Zsanitizer={sanitizer}")).env("PROPTEST_CASES", "32");
    command
}

fn miri() -> Command {
    let mut command = nightly();
    // Left to itself, it rounds powers of two at random: tests that are made of them would fail.
    let flags = "-Zmiri-disable-isolation -Zmiri-deterministic-floats -Zmiri-tree-borrows";
    command.args(["miri", "test", "--lib", "-p", FOR_MIRI]);
    command.env("PROPTEST_CASES", "4").env("MIRIFLAGS", flags);
    command
}

/// The name of this machine for compilers.
fn triple() -> Result<String, String> {
    let told = output(Command::new("rustc").arg("-vV"))?;
    let host = told.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "rustc does not say what machine this is".to_owned())
}

/// Runs what there is and says what is missing; fails if a tool finds something, or if none is there.
pub fn run(places: &Places) -> ExitCode {
    let triple = match triple() {
        Ok(triple) => triple,
        Err(why) => {
            eprintln!("xtask: {why}");
            return ExitCode::FAILURE;
        }
    };
    let mut run = 0;
    for tool in TOOLS {
        if let Some(missing) = missing(&tool) {
            println!("== {}: skipped: {missing}", tool.name);
            continue;
        }
        println!("== {}", tool.name);
        run += 1;
        if run_to_end((tool.command)(&triple).current_dir(&places.root)) != ExitCode::SUCCESS {
            eprintln!("xtask: {} found something, or does not work here", tool.name);
            return ExitCode::FAILURE;
        }
    }
    println!("{run} of {} tools were there", TOOLS.len());
    if run == 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn missing(tool: &Tool) -> Option<String> {
    let components = Command::new("rustup").args(["+nightly", "component", "list", "--installed"]).output();
    let Some(components) = components.ok().filter(|done| done.status.success()) else {
        return Some("nightly Rust is missing: `rustup toolchain install nightly`".to_owned());
    };
    let listed = String::from_utf8_lossy(&components.stdout);
    let component = tool.component;
    let there = listed.lines().any(|line| line.starts_with(component));
    (!there).then(|| format!("`rustup +nightly component add {component}`"))
}

/// `cargo xtask supply`: licences, advisories, sources and doubled crates by cargo-deny, whatever the lock file names.
pub fn supply(places: &Places) -> ExitCode {
    if output(cargo().args(["deny", "--version"])).is_err() {
        eprintln!("xtask: cargo-deny is missing: `cargo install cargo-deny`");
        return ExitCode::FAILURE;
    }
    let check = |what: &[&str]| {
        run_to_end(cargo().current_dir(&places.root).args(["deny", "--locked", "check"]).args(what))
    };
    let sound = check(&["licenses", "bans", "sources"]);
    // The list of advisories comes over the network.
    if check(&["advisories"]) != ExitCode::SUCCESS {
        println!("advisories: something was found, or the list can't be had here");
        return ExitCode::FAILURE;
    }
    sound
}
