//! `cargo xtask fuzz`: every fuzz target for a while, with its corpus and dictionary.

use std::process::{Command, ExitCode};

use crate::places::Places;
use crate::shell::{nightly, output, run_to_end};

/// The targets, as `verify::targets` and the binaries in `fuzz/` are called.
const TARGETS: [&str; 7] = ["obj", "ply", "rays", "scene", "record", "settings", "structures"];

/// How long each target runs unless told otherwise: a minute.
const SECONDS: u64 = 60;

/// Reads `[--time DURATION]`, as in `--time 10m`.
pub fn seconds(args: &[String]) -> Result<u64, String> {
    match args {
        [] => Ok(SECONDS),
        [option, text] if option == "--time" => {
            let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit()).len();
            let (number, unit) = text.split_at(digits);
            let factor = match unit {
                "" | "s" => 1,
                "m" => 60,
                "h" => 3600,
                _ => return Err(format!("`{text}` is no duration such as 90s, 10m or 1h")),
            };
            let number: Option<u64> = number.parse().ok();
            number
                .and_then(|n| n.checked_mul(factor))
                .ok_or_else(|| format!("`{text}` is no duration such as 10m"))
        }
        _ => Err("fuzz takes --time DURATION and nothing else".to_owned()),
    }
}

/// Runs the targets one after another and stops at the first that finds something, or says what is missing.
pub fn run(places: &Places, seconds: u64) -> ExitCode {
    if let Err(missing) = prepare() {
        eprintln!("xtask: {missing}");
        eprintln!(
            "without it: `cargo test -p rayscale-verify --test targets` runs every target on stable Rust"
        );
        return ExitCode::FAILURE;
    }
    for target in TARGETS {
        println!("== {target}");
        let mut command = nightly();
        command.current_dir(&places.root).args(["fuzz", "run", target, "--"]);
        command.arg(format!("-max_total_time={seconds}"));
        let dictionary = places.root.join("fuzz/dictionaries").join(target);
        if dictionary.exists() {
            command.arg(format!("-dict={}", dictionary.display()));
        }
        // A memory that is read and written by chance needs no more, and a hang is found soon.
        command.args(["-rss_limit_mb=2048", "-timeout=20"]);
        if run_to_end(&mut command) != ExitCode::SUCCESS {
            eprintln!("xtask: {target}: see fuzz/artifacts/{target}; make it a test");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn prepare() -> Result<(), String> {
    output(Command::new("rustc").args(["+nightly", "--version"]))
        .map_err(|_| "nightly Rust is missing: `rustup toolchain install nightly`".to_owned())?;
    output(nightly().args(["fuzz", "--version"]))
        .map_err(|_| "cargo-fuzz is missing: `cargo install cargo-fuzz`".to_owned())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read() {
        let read = |words: &[&str]| seconds(&words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>());
        assert_eq!(read(&[]), Ok(60));
        assert_eq!((read(&["--time", "10m"]), read(&["--time", "90"])), (Ok(600), Ok(90)));
        assert_eq!(read(&["--time", "2h"]), Ok(7200));
        for bad in [&["--time"][..], &["--time", "ten"], &["--time", "5d"], &["--time", ""], &["x", "1m"]] {
            assert!(read(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn every_target_has_a_program_and_a_corpus() {
        let root = Places::of_this_checkout().root.join("fuzz");
        for target in TARGETS {
            assert!(root.join(format!("fuzz_targets/{target}.rs")).exists(), "{target}");
            assert!(root.join("corpus").join(target).is_dir(), "{target}");
        }
    }
}
