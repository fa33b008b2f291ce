//! `rayscale report`: from a record to something to read.

use super::pictures::pictures;
use crate::console::Console;
use crate::error::Error;
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::output::write_whole;
use harness::record::{self, Record};
use report::html::{Pictures, html};
use report::{SpliceError, cells, markdown, splice, summary};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Write report.md, report.html and cells.csv from a record alone
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale report record.json
  rayscale report record.json --pictures --out reports/today
  rayscale report record.json --splice README.md")]
pub struct Report {
    /// The record
    record: PathBuf,
    /// The folder to write to; the record's own otherwise
    #[arg(short, long, value_name = "DIR", conflicts_with = "splice")]
    out: Option<PathBuf>,
    /// Instead of report files, write a summary between the markers of this text
    #[arg(long, value_name = "FILE")]
    splice: Option<PathBuf>,
    /// Put pictures of the scenes into report.html, where they are on this machine
    #[arg(long, conflicts_with = "splice")]
    pictures: bool,
}

impl Verb for Report {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let record = record::read(&self.record)?;
        let written = match &self.splice {
            Some(path) => {
                into_text(&self.record, &record, path)?;
                vec![path.clone()]
            }
            None => {
                let own = self.record.parent().map_or_else(PathBuf::new, Path::to_owned);
                let pictures = if self.pictures { pictures(&record) } else { Pictures::new() };
                write(&record, &pictures, self.out.as_deref().unwrap_or(&own))?
            }
        };
        let names: Vec<_> = written.iter().map(|path| path.display().to_string()).collect();
        console.result(&serde_json::json!({ "written": names }), names.join("\n"))?;
        Ok(Outcome::Done)
    }
}

fn into_text(from: &Path, record: &Record, path: &Path) -> Result<(), Error> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::io(path.display(), error))?;
    let command = format!("rayscale report {} --splice {}", from.display(), path.display());
    let text = splice(&text, &summary(record, &command)).map_err(|error| {
        let todo = match error {
            SpliceError::Markers(..) => "put the two lines in",
            SpliceError::Inside(..) => "take the lines out of the record",
        };
        Error::usage(format!("{}: {error}", path.display()), todo)
    })?;
    file(path, |out| out.write_all(text.as_bytes()))
}

/// Writes report.md, report.html and cells.csv to a folder and says which files these are.
pub fn write(record: &Record, pictures: &Pictures, folder: &Path) -> Result<Vec<PathBuf>, Error> {
    if !folder.as_os_str().is_empty() {
        std::fs::create_dir_all(folder).map_err(|error| Error::io(folder.display(), error))?;
    }
    let [report, page, table] = ["report.md", "report.html", "cells.csv"].map(|name| folder.join(name));
    file(&report, |out| out.write_all(markdown(record).as_bytes()))?;
    file(&page, |out| out.write_all(html(record, pictures).as_bytes()))?;
    file(&table, |out| cells::all(record).csv(out))?;
    Ok(vec![report, page, table])
}

fn file(
    path: &Path,
    write: impl FnOnce(&mut io::BufWriter<&std::fs::File>) -> io::Result<()>,
) -> Result<(), Error> {
    write_whole(path, write).map_err(|error| Error::io(path.display(), error))
}
