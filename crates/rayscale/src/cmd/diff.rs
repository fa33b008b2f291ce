//! `rayscale diff`: what changed between two records.

use super::rank::Filter;
use super::{Console, Error, Outcome, Verb};
use crate::grouped::{Change, changes};
use crate::record;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

/// Show changes of time per ray from one record to another
///
/// Changes beyond noise are marked: those whose bootstrap interval (99 %, over the raw samples) leaves out 1.
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
        shown.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
        let mut text = format!("{marked} of {} shared cells changed beyond noise", all.len());
        if before.machine != after.machine {
            text.push_str("\nthe records are from different machines or modes");
        }
        for change in &shown {
            let Change { scene, rays, structure, ratio, low, high, beyond_noise, .. } = change;
            let mark = if *beyond_noise { "*" } else { " " };
            let _ = write!(text, "\n{mark} {ratio:6.3}  [{low:.3}, {high:.3}]  {scene} {rays} {structure}");
        }
        console.result(&shown, text)?;
        let slower = |limit: f64| all.iter().any(|c| c.beyond_noise && c.ratio > 1.0 + limit);
        Ok(if self.fail_above.is_some_and(slower) { Outcome::Failed } else { Outcome::Done })
    }
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
