//! The grammar of the command line, and the program's way through it.
//!
//! Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 130 interrupted.

use crate::console::{Console, Global};
use crate::interrupt;
use crate::verb::{Outcome, Verb};
use crate::verbs::*;
use ::scenes::Folders;
use clap::{CommandFactory, Parser, Subcommand};
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

#[derive(Debug, Subcommand)]
enum Command {
    Compare(compare::Compare),
    Check(check::Check),
    Measure(measure::Measure),
    Report(report::Report),
    Cmp(cmp::Cmp),
    Rank(rank::Rank),
    Recommend(recommend::Recommend),
    Diff(diff::Diff),
    Render(render::Render),
    Trace(trace::Trace),
    Scenes(scenes::Scenes),
    Structures(structures::Structures),
    Paper(paper::PaperVerb),
    Trade(trade::Trade),
    Completions(completions::Completions),
}

impl Command {
    fn verb(&self) -> &dyn Verb {
        match self {
            Self::Compare(verb) => verb,
            Self::Check(verb) => verb,
            Self::Measure(verb) => verb,
            Self::Report(verb) => verb,
            Self::Cmp(verb) => verb,
            Self::Rank(verb) => verb,
            Self::Recommend(verb) => verb,
            Self::Diff(verb) => verb,
            Self::Render(verb) => verb,
            Self::Trace(verb) => verb,
            Self::Scenes(verb) => verb,
            Self::Structures(verb) => verb,
            Self::Trade(verb) => verb,
            Self::Completions(verb) => verb,
            Self::Paper(verb) => verb,
        }
    }
}

/// The whole program.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let Global { scenes, meshes, .. } = cli.global.clone();
    ::scenes::look_in(Folders { scenes, meshes });
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
