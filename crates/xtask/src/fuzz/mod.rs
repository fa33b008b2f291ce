//! `cargo xtask fuzz`: every fuzz target for a while, with its corpus and dictionary.

mod planted;
mod tool;

use std::process::ExitCode;

use crate::places::Places;
use crate::shell::run_to_end;
use tool::Tool;

/// The targets, as `verify::targets` and the binaries in `fuzz/` are called.
const TARGETS: [&str; 7] = ["obj", "ply", "rays", "scene", "record", "settings", "structures"];

/// How long each target runs unless told otherwise: a minute.
const SECONDS: u64 = 60;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Every target for so many seconds.
    Run(u64),
    /// How soon faults are found that are planted.
    Planted,
}

impl Wanted {
    /// Reads `[--time DURATION]`, as in `--time 10m`, or `--planted`.
    pub fn parse(args: &[String]) -> Result<Self, String> {
        match args {
            [] => Ok(Self::Run(SECONDS)),
            [option] if option == "--planted" => Ok(Self::Planted),
            [option, text] if option == "--time" => seconds(text).map(Self::Run),
            _ => Err("fuzz takes --time DURATION, or --planted, and nothing else".to_owned()),
        }
    }
}

fn seconds(text: &str) -> Result<u64, String> {
    let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit()).len();
    let (number, unit) = text.split_at(digits);
    let factor = match unit {
        "" | "s" => 1,
        "m" => 60,
        "h" => 3600,
        _ => return Err(format!("`{text}` is no duration such as 90s, 10m or 1h")),
    };
    let number: Option<u64> = number.parse().ok();
    number.and_then(|n| n.checked_mul(factor)).ok_or_else(|| format!("`{text}` is no duration such as 10m"))
}

/// Does what is wanted, or says what is missing.
pub fn run(places: &Places, wanted: Wanted) -> ExitCode {
    let done = match (Tool::find(), wanted) {
        (Err(missing), _) => Err(format!(
            "{missing}\nwithout it: `cargo test -p rayscale-verify --test targets` runs every target on stable Rust"
        )),
        (Ok(tool), Wanted::Run(seconds)) => all(places, tool, seconds),
        // Wrong answers and panics need no sanitizer to be seen.
        (Ok(_), Wanted::Planted) => planted::run(places, Tool::Stable),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the targets one after another and stops at the first that finds something.
fn all(places: &Places, tool: Tool, seconds: u64) -> Result<(), String> {
    for target in TARGETS {
        println!("== {target}");
        let mut command = tool.run(&places.root, target, &format!("-max_total_time={seconds}"));
        if run_to_end(&mut command) != ExitCode::SUCCESS {
            return Err(format!("{target}: see fuzz/artifacts/{target}; make it a test"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read() {
        let read = |words: &[&str]| Wanted::parse(&words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>());
        assert_eq!(read(&[]), Ok(Wanted::Run(60)));
        assert_eq!(read(&["--time", "10m"]), Ok(Wanted::Run(600)));
        assert_eq!(read(&["--time", "90"]), Ok(Wanted::Run(90)));
        assert_eq!(read(&["--time", "2h"]), Ok(Wanted::Run(7200)));
        assert_eq!(read(&["--planted"]), Ok(Wanted::Planted));
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
