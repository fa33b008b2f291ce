//! `cargo xtask test`: every check of the workspace, stopping at the first that fails.

use std::io::{BufRead, BufReader};
use std::process::{Command, ExitCode, Stdio};

use crate::places::{CORE, Places};
use crate::setup::Ready;
use crate::shell::{cargo, output};
use crate::structure;
use crate::tally::Tally;

/// The packages that link with Embree.
pub const ADAPTER: [&str; 2] = ["rayscale-adapter-embree", "embree4-sys"];

type Step<'a> = (&'a str, &'a dyn Fn(&mut Tally) -> Result<(), String>);

/// Runs the steps and prints how many tests passed and failed as the last line.
pub fn run(places: &Places, ready: &Ready) -> ExitCode {
    let here = |verb: &str| {
        let mut command = cargo();
        command.current_dir(&places.root).arg(verb);
        command
    };
    let workspace = |verb: &str| {
        let mut command = here(verb);
        command.arg("--workspace");
        if !ready.embree {
            command.arg("--no-default-features").args(ADAPTER.map(|package| format!("--exclude={package}")));
        }
        command
    };
    let steps: [Step; 10] = [
        ("formatting", &|_| succeed(here("fmt").args(["--all", "--check"]))),
        ("structure", &|_| structure::examine(&places.root)?.verdict()),
        ("the lock file names what the manifests ask for", &|_| {
            output(here("metadata").args(["--locked", "--format-version=1"])).map(drop)
        }),
        ("lints", &|_| {
            let mut command = workspace("clippy");
            succeed(command.args(["--all-targets", "--", "-D", "warnings"]))
        }),
        ("the contract and the structures know no Embree", &|_| {
            let mut command = here("tree");
            command.args(["--prefix", "none", "--edges", "all"]);
            no_embree_in(&output(command.args(CORE.map(|p| format!("-p{p}"))))?)
        }),
        // Without the features that others ask of the same crates.
        ("the contract and the structures build alone", &|_| {
            succeed(here("check").arg("--all-targets").args(CORE.map(|p| format!("-p{p}"))))
        }),
        ("the contract and the structures build without threads", &|_| {
            let mut command = here("check");
            succeed(command.arg("--no-default-features").args(CORE.map(|p| format!("-p{p}"))))
        }),
        ("packages", &|_| crate::package::run(places).map(|seen| print!("{seen}"))),
        ("documentation", &|_| {
            let mut command = workspace("doc");
            succeed(command.arg("--no-deps").env("RUSTDOCFLAGS", "-D warnings"))
        }),
        // Last, for they take longest.
        ("tests", &|tally| tests(&mut workspace("test"), tally)),
    ];
    let mut tally = Tally::default();
    let mut code = ExitCode::SUCCESS;
    for (name, step) in steps {
        println!("== {name}");
        if let Err(why) = step(&mut tally) {
            eprintln!("xtask: step failed: {name}: {why}");
            code = ExitCode::FAILURE;
            break;
        }
    }
    if !ready.embree {
        println!("Embree was skipped: {}", places.embree_missing().display());
    }
    println!("{} passed, {} failed", tally.passed, tally.failed);
    code
}

fn succeed(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|e| format!("cargo cannot be run: {e}"))?;
    if status.success() { Ok(()) } else { Err(status.to_string()) }
}

/// Runs `cargo test`, showing its output and counting its results.
pub fn tests(command: &mut Command, tally: &mut Tally) -> Result<(), String> {
    let mut child = command
        .arg("--no-fail-fast")
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|e| format!("cargo cannot be run: {e}"))?;
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).split(b'\n') {
            let line = line.map_err(|e| format!("cannot read from cargo: {e}"))?;
            let line = String::from_utf8_lossy(&line);
            println!("{line}");
            tally.read(&line);
        }
    }
    let status = child.wait().map_err(|e| e.to_string())?;
    if status.success() { Ok(()) } else { Err(status.to_string()) }
}

fn no_embree_in(tree: &str) -> Result<(), String> {
    let foreign = ["embree", "clang-sys", "bindgen"];
    let found = tree
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .find(|package| foreign.iter().any(|name| package.contains(name)));
    match found {
        Some(package) => Err(format!("they depend on {package}")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::no_embree_in;

    #[test]
    fn a_tree_with_embree_in_it_is_refused() {
        no_embree_in("bmssm v0.1.0\nglam v0.34.0\n").unwrap();
        let error = no_embree_in("bmssm v0.1.0\nrayscale-adapter-embree v0.1.0 (/x)\n");
        assert!(error.unwrap_err().contains("rayscale-adapter-embree"));
    }
}
