//! What a verb is, and how it ends.

use crate::console::Console;
use crate::error::Error;

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
pub fn command_line() -> String {
    // Words that are no Unicode are paths; they are said as well as can be.
    let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let words = words.map(|word| if word.contains(' ') { format!("'{word}'") } else { word });
    std::iter::once("rayscale".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}
