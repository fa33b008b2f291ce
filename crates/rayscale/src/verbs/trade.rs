//! `rayscale trade`: what accuracy costs.

use crate::console::Console;
use crate::error::Error;
use crate::options::Selection;
use crate::progress::Progress;
use crate::verb::{Outcome, Verb, command_line};
use clap::Args;
use harness::measure::Options;
use harness::output::write_whole;
use harness::trade::{self, Plan, TIMED};
use report::table::code;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Compare time and memory with errors found by exact arithmetic
///
/// Every structure and kernel answers the same rays, ordinary ones and such as hunt for errors; integers decide what is
/// missed, invented or the wrong object, and how far t is off. Writes a record, a table and a plot.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale trade --out trade
  rayscale trade --scene sponza --scene bumps-20k --structure ssm:kernel=exact --structure embree --out trade")]
pub struct Trade {
    #[command(flatten)]
    selection: Selection,
    /// Rows and columns of each set of rays that is judged
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=4096))]
    judged: u32,
    /// Most samples of a time
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    rounds: u16,
    /// Folder for trade.json, trade.md and trade.svg
    #[arg(short, long, value_name = "FOLDER")]
    out: PathBuf,
}

impl Verb for Trade {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let choices = self.selection.structures(&trade::defaults())?;
        let defaults = Options::default();
        let rounds = usize::from(self.rounds);
        let plan = Plan {
            scenes: self.selection.scenes()?,
            timed: self.selection.rays(TIMED)?,
            size: self.selection.size.unwrap_or(128),
            judged: self.judged,
            seed: self.selection.seed,
            options: Options {
                threads: console.threads().unwrap_or(1),
                rounds,
                least_rounds: defaults.least_rounds.min(rounds),
                ..defaults
            },
            command: command_line(),
        };
        std::fs::create_dir_all(&self.out).map_err(|error| Error::io(self.out.display(), error))?;
        let mut progress = Progress::new(console, plan.scenes.len() * plan.timed.len(), "measuring");
        let trade = console.in_pool(1, || trade::run(&plan, &choices, &mut progress))??;
        progress.finish();
        let table = report::trade::table(&trade.rows);
        let json = serde_json::to_string_pretty(&trade).map_err(io::Error::other);
        let json = json.map_err(|error| Error::io("trade.json", error))?;
        let text =
            format!("# Accuracy and its cost\n\nMade by {}.\n\n{}", code(&trade.command), table.markdown());
        self.write("trade.json", &json)?;
        self.write("trade.md", &text)?;
        self.write("trade.svg", &report::trade::svg(&trade))?;
        console.result(&trade, table.text())?;
        let failed = trade.rows.iter().filter_map(|row| Some((row, row.outcome.reason()?)));
        let lines: Vec<String> =
            failed.map(|(row, reason)| format!("{} {}: {reason}", row.scene, row.structure)).collect();
        lines.iter().for_each(|line| console.note(line));
        Ok(if lines.is_empty() { Outcome::Done } else { Outcome::Failed })
    }
}

impl Trade {
    fn write(&self, name: &str, text: &str) -> Result<(), Error> {
        let path: &Path = &self.out.join(name);
        let written: Result<(), io::Error> = write_whole(path, |out| out.write_all(text.as_bytes()));
        written.map_err(|error| Error::io(path.display(), error))
    }
}
