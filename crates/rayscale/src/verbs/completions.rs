//! `rayscale completions`

use crate::console::Console;
use crate::error::Error;
use crate::verb::{Outcome, Verb};
use clap::Args;
use clap_complete::Shell;
use std::io::{self, Write};

/// Print a script that completes rayscale's commands in your shell
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rayscale completions bash > ~/.local/share/bash-completion/completions/rayscale
  rayscale completions zsh > ~/.zfunc/_rayscale
  rayscale completions fish > ~/.config/fish/completions/rayscale.fish")]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Verb for Completions {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut console.grammar(), "rayscale", &mut script);
        if console.json() {
            let script = String::from_utf8_lossy(&script);
            console.result(&serde_json::json!({ "shell": self.shell.to_string(), "script": script }), "")?;
        } else {
            io::stdout().write_all(&script).map_err(|error| Error::io("standard output", error))?;
        }
        Ok(Outcome::Done)
    }
}
