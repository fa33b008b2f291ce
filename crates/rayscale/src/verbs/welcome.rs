//! What the program says when it is asked for nothing.

use crate::console::Console;
use crate::error::Error;
use crate::verb::Outcome;
use serde_json::json;
use std::fmt::Write;

/// Prints what to do next.
pub fn print(console: &Console) -> Result<Outcome, Error> {
    let grammar = console.grammar();
    let about = grammar.get_about().map(ToString::to_string).unwrap_or_default();
    let mut text = format!("{about}\n\nWhat there is to do:\n");
    let mut verbs = Vec::new();
    for verb in grammar.get_subcommands() {
        let (name, about) = (verb.get_name(), verb.get_about().map(ToString::to_string).unwrap_or_default());
        // Writing to a string does not fail.
        let _ = writeln!(text, "  rayscale {name:<12} {about}");
        verbs.push(json!({ "verb": name, "about": about }));
    }
    text.push_str("\n`rayscale help VERB` explains each, with examples.");
    console.result(&json!({ "about": about, "verbs": verbs }), text)?;
    Ok(Outcome::Done)
}
