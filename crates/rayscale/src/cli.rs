//! The grammar of the command line, and the program's way through it.
//!
//! Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 130 interrupted.

use crate::console::{Console, Global};
use crate::interrupt;
use crate::verb::Outcome;
use crate::verbs::{Command, welcome};
use clap::{CommandFactory, Parser};
use scenes::Folders;
use std::process::ExitCode;

/// Compares ray-tracing acceleration structures: time, memory and accuracy in one table.
#[derive(Debug, Parser)]
#[command(name = "rayscale", version, propagate_version = true, max_term_width = 100)]
struct Cli {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Option<Command>,
}

/// The whole program.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let Global { scenes_folder, meshes_folder, .. } = cli.global.clone();
    scenes::look_in(Folders { scenes: scenes_folder, meshes: meshes_folder });
    let console = Console::new(cli.global, grammar);
    let outcome = match &cli.command {
        Some(command) => command.verb().run(&console),
        None => welcome::print(&console),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Ok(Outcome::Interrupted) => ExitCode::from(interrupt::EXIT_CODE),
        // Whoever read the output has seen enough, as in `rayscale scenes | head`.
        Err(error) if error.is_closed_pipe() => ExitCode::SUCCESS,
        Err(error) => {
            console.error(&error);
            ExitCode::from(2)
        }
    }
}

/// The program's grammar, for help texts and completions.
pub fn grammar() -> clap::Command {
    Cli::command()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn completions_know_the_names_there_are() {
        let mut script = Vec::new();
        clap_complete::generate(clap_complete::Shell::Bash, &mut grammar(), "rayscale", &mut script);
        let script = String::from_utf8(script).unwrap();
        for name in ["obvhs-cwbvh", "leak-edge", "baldwin-weber"] {
            assert!(script.contains(name), "{name}");
        }
    }

    #[test]
    fn the_grammar_is_sound() {
        grammar().debug_assert();
    }

    #[test]
    fn every_verb_has_help_and_examples() {
        for verb in grammar().get_subcommands() {
            let name = verb.get_name();
            assert!(verb.get_about().is_some(), "`{name}` says what it does");
            let examples = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(examples.contains(&format!("rayscale {name}")), "`{name}` has examples");
            for argument in verb.get_arguments() {
                assert!(argument.get_help().is_some(), "`{name}`: {} has help", argument.get_id());
            }
        }
    }
}
