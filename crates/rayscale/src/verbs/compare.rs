//! `rayscale compare`: check, measure and report.

use super::measure::{Effort, failures, interrupted, measure};
use super::pictures::pictures;
use super::{check, report};
use crate::console::Console;
use crate::error::{Error, check_place};
use crate::options::Selection;
use crate::verb::{Outcome, Verb};
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;

/// Check and measure every structure on the default set, and write a report
///
/// The default set takes eight to ten minutes; ray sets that no time is left for are named. Everything goes to the folder
/// named by --out: record.json, report.html, report.md and cells.csv.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale compare
  rayscale compare --scene model.obj --out model
  rayscale compare --structure ssm --structure embree --rays parallel,random
  rayscale compare --full")]
pub struct Compare {
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    effort: Effort,
    /// Larger rasters, no limit of time, and the full check beforehand
    #[arg(long)]
    full: bool,
    /// The folder to write to
    #[arg(short, long, value_name = "DIR", default_value = "reports/latest")]
    out: PathBuf,
}

/// Time that the default set is given.
const TIME: Duration = Duration::from_secs(540);
/// Rows and columns with `--full`.
const FULL_SIZE: u32 = 512;

impl Verb for Compare {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let mut selection = self.selection.clone();
        let mut effort = self.effort.clone();
        let mut sound = true;
        std::fs::create_dir_all(&self.out).map_err(|error| Error::io(self.out.display(), error))?;
        let path = self.out.join("record.json");
        check_place(&path)?;
        if self.full {
            sound = check::full(console, &selection)?.is_sound();
            selection.size = selection.size.or(Some(FULL_SIZE));
        } else {
            effort.time_budget = effort.time_budget.or(Some(TIME));
        }
        let record = measure(console, &selection, &effort, &path)?;
        if let Some(outcome) = interrupted(console, &record, &path)? {
            return Ok(outcome);
        }
        let mut written = vec![path];
        written.extend(report::write(&record, &pictures(&record), &self.out)?);
        let failed = failures(&record);
        failed.iter().for_each(|line| console.note(line));
        let names: Vec<_> = written.iter().map(|path| path.display().to_string()).collect();
        console.result(
            &serde_json::json!({ "written": names, "cells": record.cells.len(), "failed": failed.len() }),
            format_args!("{} cells, {} failed\n{}", record.cells.len(), failed.len(), names.join("\n")),
        )?;
        Ok(if sound && failed.is_empty() { Outcome::Done } else { Outcome::Failed })
    }
}
