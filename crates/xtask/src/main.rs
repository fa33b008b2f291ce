//! Set-up and the two commands of the README.
//!
//! ```text
//! cargo xtask setup             find or install Embree 4, fetch the real meshes
//! cargo xtask compare [ARGS]    set up, then `rayscale compare ARGS`
//! cargo xtask bench [ARGS]      set up, then the criterion benches
//! cargo xtask test              set up, then every check of the workspace
//! cargo xtask structure         which crates and modules import which, and that there is no cycle
//! cargo xtask package           the crates meant for others, and a program outside of the checkout that uses them
//! cargo xtask fuzz              every fuzz target for a while; or how soon planted faults are found
//! cargo xtask sanitize          the tests of what holds `unsafe` under sanitizers and miri
//! cargo xtask supply            licences, advisories and sources of all dependencies
//! cargo xtask interrupt         a measurement killed, or out of disk, at a thousand random moments
//! cargo xtask processors        the program on emulated x86-64 processors that lack instructions
//! cargo xtask aarch64           the structures' tests with NEON, emulated if need be
//! ```
#![forbid(unsafe_code)]

mod aarch64;
mod bench;
mod checks;
mod compare;
mod embree;
mod fuzz;
mod host;
mod interrupt;
mod meshes;
mod native;
mod package;
mod pip;
mod places;
mod processors;
mod sanitize;
mod setup;
mod share;
mod shell;
mod structure;
mod tally;

use meshes::Wanted;
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask <command>

  setup [MESH…]     find Embree 4 or install it; fetch the real meshes, the large ones only if named
                    or with --all
  compare [ARGS]    set up, build for this machine, then run `rayscale compare ARGS`
  bench [ARGS]      set up, then `cargo bench --workspace ARGS`, built for this machine
  test              set up, then formatting, lints, tests, documentation
  structure         list which crates and modules import which; fail on a cycle
  package           package the crates meant for others; build and run a program that has only those
  fuzz [--time 10m] every fuzz target for so long, a minute otherwise; needs cargo-fuzz, takes nightly Rust if there is
  fuzz --planted    how soon the fuzz targets find each of a number of faults put into a copy of the checkout
  sanitize          the tests of what holds unsafe code under address and thread sanitizers and miri
  supply            licences, advisories and sources of all dependencies; needs cargo-deny
  interrupt [N]     a short measurement killed, or out of disk, at a thousand random moments, or N
  processors        the program on emulated x86-64 processors without AVX, BMI or LZCNT: equal hits?
  aarch64           the tests of the contract and the structures for aarch64, emulated on other processors

Exit codes: 0 done, 1 a step failed, 2 bad usage.";

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let verb = args.next().unwrap_or_default();
    let rest: Vec<String> = args.collect();
    let places = places::Places::of_this_checkout();
    match (verb.as_str(), rest.is_empty()) {
        ("setup", _) => match Wanted::parse(&rest) {
            Ok(wanted) => match setup::run(&places, wanted) {
                Ok(_) => ExitCode::SUCCESS,
                Err(why) => fail(&format!("set-up failed: {why}")),
            },
            Err(why) => misused(why),
        },
        ("compare", _) => match setup::run(&places, Wanted::Usual) {
            Ok(ready) => compare::run(&places, &ready, &rest),
            Err(why) => fail(&format!("set-up failed: {why}")),
        },
        ("bench", _) => match setup::run(&places, Wanted::Usual) {
            Ok(ready) => bench::run(&places, &ready, &rest),
            Err(why) => fail(&format!("set-up failed: {why}")),
        },
        ("test", true) => match setup::run(&places, Wanted::Usual) {
            Ok(ready) => checks::run(&places, &ready),
            Err(why) => fail(&format!("set-up failed: {why}")),
        },
        ("structure", true) => structure(&places),
        ("package", true) => match package::run(&places) {
            Ok(seen) => {
                print!("{seen}");
                ExitCode::SUCCESS
            }
            Err(why) => fail(&why),
        },
        ("fuzz", _) => fuzz::Wanted::parse(&rest).map_or_else(misused, |wanted| fuzz::run(&places, wanted)),
        ("sanitize", true) => sanitize::run(&places),
        ("supply", true) => sanitize::supply(&places),
        ("interrupt", _) => {
            interrupt::moments(&rest).map_or_else(misused, |moments| interrupt::run(&places, moments))
        }
        ("processors", true) => processors::run(&places),
        ("aarch64", true) => aarch64::run(&places),
        ("help" | "--help" | "-h", _) => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}

fn structure(places: &places::Places) -> ExitCode {
    match structure::examine(&places.root) {
        Ok(findings) => {
            print!("{}", findings.listing);
            findings.verdict().map_or_else(|faults| fail(&faults), |()| ExitCode::SUCCESS)
        }
        Err(why) => fail(&why),
    }
}

/// Says what is wrong with the arguments.
fn misused(why: String) -> ExitCode {
    eprintln!("xtask: {why}");
    ExitCode::from(2)
}

fn fail(message: &str) -> ExitCode {
    eprintln!("xtask: {message}");
    ExitCode::FAILURE
}
