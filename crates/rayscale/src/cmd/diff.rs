//! `rayscale diff`: what changed between two records.

use super::rank::Filter;
use super::{Console, Error, Outcome, Verb};
use crate::changes::{Change, changes};
use crate::record;
use crate::stats::median;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

/// Show changes of time per ray from one record to another
///
/// Changes beyond noise are marked: those whose interval leaves out 1. It is a bootstrap interval over the raw samples (99 %),
/// widened by how far the other structures' cells spread and drift between the two records.
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
    /// Show changes within noise as well
    #[arg(long)]
    all: bool,
    /// Exit with 1 if any cell got slower beyond noise, and by more than so much, such as 10%
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
        let marked = all.iter().filter(|change| change.beyond_noise).count();
        let mut shown: Vec<&Change> = all.iter().filter(|c| self.all || c.beyond_noise).collect();
        shown.sort_by(|a, b| b.relative().total_cmp(&a.relative()));
        let mut text = format!("{marked} of {} shared cells changed beyond noise", all.len());
        if before.machine != after.machine {
            text.push_str("\nthe records are from different machines or modes");
        }
        if let Some(drift) = drift(&all) {
            let _ = write!(
                text,
                "\nall together: {drift:.3} (the machine, or what all share); what follows is relative to the other structures"
            );
        }
        for change in &shown {
            let Change { scene, rays, structure, low, high, beyond_noise, .. } = change;
            let ratio = change.relative();
            let mark = if *beyond_noise { "*" } else { " " };
            let _ = write!(text, "\n{mark} {ratio:6.3}  [{low:.3}, {high:.3}]  {scene} {rays} {structure}");
        }
        console.result(&shown, text)?;
        let slower = |limit: f64| all.iter().any(|c| c.beyond_noise && c.relative() > 1.0 + limit);
        Ok(if self.fail_above.is_some_and(slower) { Outcome::Failed } else { Outcome::Done })
    }
}

/// The middle of all ratios, if that is more than a few per cent from 1.
fn drift(all: &[Change]) -> Option<f64> {
    let ratios: Vec<f64> = all.iter().map(|change| change.ratio).collect();
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
