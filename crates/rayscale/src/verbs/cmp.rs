//! `rayscale cmp`: a record's figures side by side.

use crate::console::Console;
use crate::error::Error;
use crate::options::{Filter, measures};
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::grouped::Measure;
use harness::record;
use report::cells;
use std::path::PathBuf;

/// Show a record's figures side by side
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale cmp record.json
  rayscale cmp record.json --measure build --scene sponza")]
pub struct Cmp {
    /// The record
    record: PathBuf,
    /// What is shown
    #[arg(long, value_parser = measures(), default_value = "trace")]
    measure: Measure,
    #[command(flatten)]
    filter: Filter,
}

impl Verb for Cmp {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let mut record = record::read(&self.record)?;
        record.cells.retain(|cell| self.filter.takes(cell));
        if record.cells.is_empty() {
            return Err(Error::usage(
                format!("{}: no cell passes these filters", self.record.display()),
                "leave out a filter",
            ));
        }
        console.result(&record.cells, cells::figures(&record.cells, self.measure).text())?;
        Ok(Outcome::Done)
    }
}
