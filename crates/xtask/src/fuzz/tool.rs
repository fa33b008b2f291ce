//! cargo-fuzz, by the Rust there is.

use std::path::Path;
use std::process::Command;

use crate::shell::{cargo, nightly, output};

/// A cargo that has cargo-fuzz, and a compiler that instruments.
#[derive(Clone, Copy)]
pub enum Tool {
    /// Nightly Rust, with the address sanitizer.
    Nightly,
    /// The Rust of the workspace, told to be let do what nightly may; without a sanitizer, which stable Rust lacks.
    Stable,
}

/// The target whose bytes are numbers, each of which means something. What they are compared with is nothing to try in their place, and
/// to look out for it takes a third of the time; to weigh inputs by how rare what they reach is takes longer than to run them, as
/// soon as there are some thousand of them.
const NUMBERS: &str = "structures";

impl Tool {
    /// The better one of those that there are.
    ///
    /// # Errors
    /// What is missing.
    pub fn find() -> Result<Self, String> {
        let there = output(Command::new("rustc").args(["+nightly", "--version"])).is_ok();
        let tool = if there { Self::Nightly } else { Self::Stable };
        output(tool.cargo().args(["fuzz", "--version"]))
            .map_err(|_| "cargo-fuzz is missing: `cargo install cargo-fuzz`".to_owned())?;
        Ok(tool)
    }

    fn cargo(self) -> Command {
        match self {
            Self::Nightly => nightly(),
            Self::Stable => {
                let mut command = cargo();
                command.env("RUSTC_BOOTSTRAP", "1");
                command
            }
        }
    }

    fn fuzz(self, root: &Path, verb: &str, target: &str) -> Command {
        let mut command = self.cargo();
        command.current_dir(root).args(["fuzz", verb]);
        if matches!(self, Self::Stable) {
            command.args(["-s", "none"]);
        }
        if target == NUMBERS {
            command.arg("--no-trace-compares");
        }
        command.arg(target);
        command
    }

    /// Builds a target of the checkout `root`.
    pub fn build(self, root: &Path, target: &str) -> Command {
        self.fuzz(root, "build", target)
    }

    /// Runs a target from its corpus, with its dictionary and this limit.
    pub fn run(self, root: &Path, target: &str, limit: &str) -> Command {
        let mut command = self.fuzz(root, "run", target);
        command.args(["--", limit]);
        if target == NUMBERS {
            command.arg("-entropic=0");
        }
        let dictionary = root.join("fuzz/dictionaries").join(target);
        if dictionary.exists() {
            command.arg(format!("-dict={}", dictionary.display()));
        }
        // A memory that is read and written by chance needs no more, and a hang is found soon.
        command.args(["-rss_limit_mb=2048", "-timeout=20"]);
        command
    }
}
