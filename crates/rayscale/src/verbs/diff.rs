//! `rayscale diff`: what changed between two records.

use crate::console::Console;
use crate::error::Error;
use crate::options::Filter;
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::changes::{Change, Changes, Judged, changes};
use harness::record;
use harness::stats::median;
use std::fmt::Write;
use std::path::PathBuf;

/// Show changes of time per ray from one record to another
///
/// Compares times per ray: of each structure as a whole (the middle of its cells' ratios) and of each cell. A cell's time is
/// its least sample, or the middle of its passes' least where that is known better.
/// Changes beyond noise are marked: those whose range leaves out 1. The range is as wide as a bootstrap over the raw
/// samples and passes says, and as the other structures spread about their drift between the two records, several times over.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale diff before.json after.json
  rayscale diff before.json after.json --rays parallel --all
  rayscale diff before.json after.json --fail-above 10%")]
pub struct Diff {
    /// The record before
    before: PathBuf,
    /// The record after
    after: PathBuf,
    #[command(flatten)]
    filter: Filter,
    /// Show what is within noise as well
    #[arg(long)]
    all: bool,
    /// Exit with 1 if any structure or cell got slower beyond noise, and by more than so much, such as 10%
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    fail_above: Option<f64>,
}

/// A share by percent, the sign being optional.
fn percent(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('%').unwrap_or(text).trim().parse::<f64>();
    let sound = number.ok().filter(|percent| *percent >= 0.0 && percent.is_finite());
    sound.map(|percent| percent / 100.0).ok_or_else(|| "must be a percentage such as 10%".to_owned())
}

impl Verb for Diff {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let mut before = record::read(&self.before)?;
        let after = record::read(&self.after)?;
        before.cells.retain(|cell| self.filter.takes(cell));
        let all = changes(&before, &after);
        let mut text = headline(&all);
        if before.machine != after.machine {
            text.push_str("\nthe records are from different machines or modes");
        }
        if let Some(drift) = drift(&all) {
            let _ = write!(
                text,
                "\nall together: {drift:.3} (the machine, or what all share); what follows is relative to the other structures"
            );
        }
        let mut shown = Changes {
            structures: all.structures.iter().filter(|s| self.shows(&s.judged)).cloned().collect(),
            cells: all.cells.iter().filter(|c| self.shows(&c.judged)).cloned().collect(),
        };
        shown.structures.sort_by(|a, b| b.judged.relative().total_cmp(&a.judged.relative()));
        shown.cells.sort_by(|a, b| b.judged.relative().total_cmp(&a.judged.relative()));
        for shift in &shown.structures {
            line(&mut text, &shift.judged, &format!("{}, {}", shift.structure, cells(shift.cells)));
        }
        for change in &shown.cells {
            let Change { scene, rays, structure, judged, .. } = change;
            line(&mut text, judged, &format!("{structure} {scene} {rays}"));
        }
        console.result(&shown, text)?;
        let slower = |limit: f64| judged(&all).any(|c| c.beyond_noise && c.relative() > 1.0 + limit);
        Ok(if self.fail_above.is_some_and(slower) { Outcome::Failed } else { Outcome::Done })
    }
}

impl Diff {
    fn shows(&self, judged: &Judged) -> bool {
        self.all || judged.beyond_noise
    }
}

fn judged(all: &Changes) -> impl Iterator<Item = &Judged> {
    all.structures.iter().map(|s| &s.judged).chain(all.cells.iter().map(|c| &c.judged))
}

fn headline(all: &Changes) -> String {
    let structures = all.structures.iter().filter(|s| s.judged.beyond_noise).count();
    let marked = all.cells.iter().filter(|c| c.judged.beyond_noise).count();
    format!(
        "{structures} of {} structures changed beyond noise, and {marked} of {} shared cells by themselves",
        all.structures.len(),
        all.cells.len()
    )
}

fn cells(n: usize) -> String {
    if n == 1 { "its one cell".to_owned() } else { format!("the middle of {n} cells") }
}

fn line(text: &mut String, judged: &Judged, what: &str) {
    let Judged { low, high, beyond_noise, .. } = judged;
    let mark = if *beyond_noise { "*" } else { " " };
    // Writing to a string does not fail.
    let _ = write!(text, "\n{mark} {:6.3}  [{low:.3}, {high:.3}]  {what}", judged.relative());
}

/// The middle of all ratios, if that is more than a few per cent from 1.
fn drift(all: &Changes) -> Option<f64> {
    let ratios: Vec<f64> = all.cells.iter().map(|change| change.judged.ratio).collect();
    median(&ratios).filter(|ratio| ratio.ln().abs() > 0.03)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages() {
        assert_eq!(percent("10%"), Ok(0.1));
        assert_eq!(percent("0"), Ok(0.0));
        for bad in ["", "%", "-1%", "NaN", "ten"] {
            assert!(percent(bad).is_err(), "{bad}");
        }
    }
}
