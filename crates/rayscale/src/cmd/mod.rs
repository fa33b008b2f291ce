//! The command line: one file a verb, and what verbs share.
//!
//! A verb is a `clap::Args` struct that is a [`Verb`]; it is plugged in at three places of this
//! file: its module, its variant of `Command`, its arm of `Command::verb`.
//!
//! Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 130 interrupted.

mod check;
mod cmp;
mod compare;
mod completions;
mod console;
mod diff;
mod error;
mod interrupt;
mod kernel;
mod measure;
mod paper;
mod rank;
mod recommend;
mod render;
mod report;
mod scenes;
mod selection;
mod structure;
mod structures;
mod trace;
mod trade;
mod welcome;

pub use console::Console;
pub use error::Error;

use clap::{Args, CommandFactory, Parser, Subcommand};
use std::num::NonZeroUsize;
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

/// Options of every verb.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Everywhere")]
pub struct Global {
    /// No progress and no notes; results and errors only
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Print results as JSON
    #[arg(long, global = true)]
    pub json: bool,
    /// Threads to use; each verb's help says what it uses otherwise
    #[arg(long, global = true, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
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

/// Something the program does.
pub trait Verb {
    /// Does it.
    ///
    /// # Errors
    /// Bad usage or input: what is wrong, where, and what to do.
    fn run(&self, console: &Console) -> Result<Outcome, Error>;
}

/// How a verb ended that did what it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All is well: exit code 0.
    Done,
    /// What was to be checked is not so: exit code 1.
    Failed,
    /// The user stopped it; what was done by then is kept: exit code 130.
    Interrupted,
}

/// The command line as given.
fn command_line() -> String {
    let words =
        std::env::args().skip(1).map(|word| if word.contains(' ') { format!("'{word}'") } else { word });
    std::iter::once("rayscale".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// The whole program.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let console = Console::new(cli.global);
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
