//! `rayscale structures`

use crate::console::Console;
use crate::error::Error;
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::registry::{self, Entry};
use serde_json::json;
use std::fmt::Write;

/// List the structures with their settings
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rayscale structures
  rayscale structures --json")]
pub struct Structures {}

impl Verb for Structures {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let mut text = String::new();
        for entry in registry::entries() {
            let Entry { id, description, source, settings, .. } = entry;
            let source = if source.is_empty() { String::new() } else { format!(" [{source}]") };
            // Writing to a string does not fail.
            let _ = writeln!(text, "{id}\n    {description}{source}");
            for (name, help) in *settings {
                let _ = writeln!(text, "    {name:<12} {help}");
            }
        }
        for absent in registry::absent() {
            let _ = writeln!(text, "{}\n    not available: {}", absent.id, absent.reason);
        }
        text.push_str("\nSettings follow the id after a colon: `ssm:kernel=watertight`.");
        let present = registry::entries().iter().map(|entry| {
            let settings: Vec<_> =
                entry.settings.iter().map(|(name, help)| json!({ "name": name, "help": help })).collect();
            json!({
                "id": entry.id, "description": entry.description, "source": entry.source,
                "version": (entry.version)(), "settings": settings,
            })
        });
        let absent = registry::absent().into_iter().map(|a| json!({ "id": a.id, "absent": a.reason }));
        console.result(&present.chain(absent).collect::<Vec<_>>(), text)?;
        Ok(Outcome::Done)
    }
}
