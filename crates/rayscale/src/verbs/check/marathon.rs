//! `rayscale check --marathon`: a long run that goes on where it was.

use crate::console::Console;
use crate::error::{Error, check_place};
use crate::interrupt;
use crate::verb::Outcome;
use accel::Cancel;
use harness::machine::Machine;
use harness::output::{Claim, ClaimError, write_whole};
use harness::record::Suite;
use harness::units;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::Ordering;
use verify::marathon::{Goal, Record, run};

/// Goes on with the record, or begins one with the seed.
pub fn marathon(console: &Console, path: &Path, goal: Goal, seed: u64) -> Result<Outcome, Error> {
    check_place(path)?;
    let _claim = Claim::of(path).map_err(|error| match error {
        ClaimError::Taken => {
            Error::usage(format!("{}: another run is writing it", path.display()), "wait for it")
        }
        ClaimError::Io(error) => Error::io(path.display(), error),
    })?;
    let suite = Suite::this();
    let version = format!("{} {} {}", suite.version, suite.git, suite.profile);
    let machine = Machine::here();
    let mut record = match path.exists() {
        true => read(path)?,
        false => Record::new(version.clone(), format!("{}, {}", machine.cpu, machine.isa), seed),
    };
    if record.version != version {
        return Err(Error::usage(
            format!("{}: it was begun by {}, and this is {version}", path.display(), record.version),
            "give --marathon another file",
        ));
    }
    let flag = interrupt::flag(console)?;
    let interrupted = || flag.load(Ordering::Relaxed);
    let keep = |record: &Record| {
        console.note(format_args!(
            "{} rays, {} differences",
            units::count(record.rays),
            record.differences.len()
        ));
        write(path, record)
    };
    run(&mut record, goal, Cancel::when(&interrupted), keep)?;
    let text = format!(
        "{} rays of {} cases compared with brute force, {} of them with exact arithmetic; {} differences → {}",
        units::count(record.rays),
        units::count(record.next_seed - record.first_seed),
        units::count(record.exact),
        record.differences.len(),
        path.display()
    );
    let faults: String = record.differences.iter().map(|what| format!("\n{what}")).collect();
    console.result(&record, text + &faults)?;
    Ok(match (record.differences.is_empty(), interrupted()) {
        (false, _) => Outcome::Failed,
        (true, true) => Outcome::Interrupted,
        (true, false) => Outcome::Done,
    })
}

fn read(path: &Path) -> Result<Record, Error> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::io(path.display(), error))?;
    serde_json::from_str(&text).map_err(|error| {
        Error::usage(
            format!("{}: no record of a marathon: {error}", path.display()),
            "give --marathon another file",
        )
    })
}

fn write(path: &Path, record: &Record) -> Result<(), Error> {
    let written: std::io::Result<()> = write_whole(path, |out| {
        serde_json::to_writer_pretty(&mut *out, record)?;
        out.write_all(b"\n")
    });
    written.map_err(|error| Error::io(path.display(), error))
}
