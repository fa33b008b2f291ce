//! `rayscale measure`: a record.

use crate::console::Console;
use crate::error::{Error, check_place};
use crate::interrupt;
use crate::options::Selection;
use crate::progress::Progress;
use crate::verb::{Outcome, Verb, command_line};
use clap::Args;
use harness::measure::{self, Deadline, Options, Session};
use harness::output::{Claim, ClaimError};
use harness::record::{self, Cell, Record};
use harness::registry::{self, Choice};
use harness::units;
use harness::workload::Subject;
use scenes::rays::RaysId;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Check and measure; write everything to a record
///
/// Structures take turns, round by round. The answers of every sample are checked. One thread builds and
/// traces unless --threads says otherwise. The record is written anew after every ray set: Ctrl-C or worse costs the
/// one being measured, and --resume goes on.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale measure --out record.json
  rayscale measure --scene small-100k --rays parallel,random --structure embree --structure ssm --out a.json
  rayscale measure --scene model.obj --counters --out model.json
  rayscale measure --time-budget 10m --out record.json --resume")]
pub struct Measure {
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    effort: Effort,
    /// The record to write
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
}

/// Rows and columns of rasters.
const SIZE: u32 = 256;

/// How much is measured.
#[derive(Clone, Debug, Args)]
pub struct Effort {
    /// Most samples of a cell
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    pub rounds: u16,
    /// Passes over the ray sets of a scene that share these samples, each with other builds where there is time
    /// [default: 3; 5 from 15 rounds on]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub passes: Option<u16>,
    /// Spend about so long in all, such as 90s or 1h30m: the cells share the time, and what none is left for is skipped
    #[arg(long, value_name = "DURATION", value_parser = units::duration)]
    pub time_budget: Option<Duration>,
    /// Go on with the record if there is one: what is in it stays and is not measured again
    #[arg(long)]
    pub resume: bool,
    /// Count steps per ray, in a run of its own
    #[arg(long)]
    pub counters: bool,
    /// Leave out memory by resolution
    #[arg(long)]
    pub no_memory: bool,
}

impl Verb for Measure {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let record = measure(console, &self.selection, &self.effort, &self.out)?;
        if let Some(outcome) = interrupted(console, &record, &self.out)? {
            return Ok(outcome);
        }
        let failed = failures(&record);
        let cells = record.cells.len();
        console.result(
            &serde_json::json!({ "record": self.out.to_string_lossy(), "cells": cells, "failed": failed.len() }),
            format_args!("{}: {cells} cells, {} of them failed", self.out.display(), failed.len()),
        )?;
        failed.iter().for_each(|line| console.note(line));
        Ok(if failed.is_empty() { Outcome::Done } else { Outcome::Failed })
    }
}

/// Measures a selection and writes the record, anew after every ray set.
pub fn measure(
    console: &Console,
    selection: &Selection,
    effort: &Effort,
    out: &Path,
) -> Result<Record, Error> {
    let choices = selection.structures(&registry::defaults())?;
    let defaults = Options::default();
    let session = Session {
        subject: Subject {
            scenes: selection.scenes()?,
            rays: selection.rays(RaysId::measured())?,
            size: selection.size.unwrap_or(SIZE),
            seed: selection.seed,
        },
        options: Options {
            threads: console.threads().unwrap_or(1),
            passes: usize::from(effort.passes.unwrap_or(if effort.rounds < 15 { 3 } else { 5 })),
            rounds: usize::from(effort.rounds),
            least_rounds: defaults.least_rounds.min(usize::from(effort.rounds)),
            counters: effort.counters,
            ..defaults
        },
        memory: !effort.no_memory,
        deadline: Deadline::new(interrupt::flag(console)?, effort.time_budget),
        command: without_resume(&command_line()),
    };
    check_place(out)?;
    let _claim = claim(out)?;
    let begun = begun(&session, &choices, effort, out)?;
    let steps = session.subject.scenes.len() * session.subject.rays.len() * session.options.passes();
    let mut progress = Progress::new(console, steps, "measuring");
    let mut unwritten = None;
    let record = console.in_pool(1, || {
        measure::run(&session, &choices, begun, &mut progress, |record| {
            unwritten = record::write(out, record).err();
        })
    })??;
    progress.finish();
    // What was measured is shown even where it can't be written; the error comes last.
    if unwritten.is_some() || record.scenes.is_empty() {
        record::write(out, &record)?;
    }
    Ok(record)
}

/// A record is written again and again: of two runs that do so, the last would win in silence.
fn claim(out: &Path) -> Result<Claim, Error> {
    Claim::of(out).map_err(|error| match error {
        ClaimError::Taken => Error::usage(
            format!("{}: another run is writing this record", out.display()),
            "wait for it, or give --out another name",
        ),
        ClaimError::Io(error) => Error::io(out.display(), error),
    })
}

/// A new record, or the one to go on with.
fn begun(session: &Session, choices: &[Choice], effort: &Effort, out: &Path) -> Result<Record, Error> {
    if effort.resume && out.exists() {
        return Ok(measure::resume(record::read(out)?, session, choices)?);
    }
    Ok(measure::begin(session, choices))
}

/// If the run was interrupted, says what there is and how to go on.
pub fn interrupted(console: &Console, record: &Record, path: &Path) -> Result<Option<Outcome>, Error> {
    if record.run.is_none_or(|run| run.complete) {
        return Ok(None);
    }
    let again = without_resume(&command_line()) + " --resume";
    let cells = record.cells.len();
    console.result(
        &serde_json::json!({ "record": path.to_string_lossy(), "cells": cells, "interrupted": true, "resume": again }),
        format_args!("stopped: {} holds the {cells} cells done by then; to go on:\n{again}", path.display()),
    )?;
    Ok(Some(Outcome::Interrupted))
}

/// A command line as it was before anyone went on with it.
fn without_resume(command: &str) -> String {
    command.replace(" --resume", "")
}

/// A line for each cell that failed.
pub fn failures(record: &Record) -> Vec<String> {
    let failed = record.cells.iter().filter(|cell| cell.outcome.is_failed());
    let line = |cell: &Cell| {
        let reason = cell.outcome.reason().unwrap_or_default();
        format!("{} {} {}: {reason}", cell.scene, cell.rays, cell.structure)
    };
    failed.map(line).collect()
}
