//! `rayscale rank`: geometric means of ratios.

use crate::console::Console;
use crate::error::Error;
use crate::options::{Filter, measures};
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::grouped::{Measure, Ranking, rank};
use harness::record;
use harness::units::ratio;
use report::table::in_columns;
use std::fmt::Write;
use std::path::PathBuf;

/// Rank structures by ratios to one of them
///
/// A structure's ratio is the geometric mean, over the cells in which all structures have a figure, of its
/// figure over that of the structure named by --to.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale rank record.json --to embree
  rayscale rank record.json --to bmssm --measure build
  rayscale rank record.json --to embree --rays parallel,perspective")]
pub struct Rank {
    /// The record
    record: PathBuf,
    /// The structure that ratios are to
    #[arg(long, value_name = "ID")]
    to: String,
    /// What is compared
    #[arg(long, value_parser = measures(), default_value = "trace")]
    measure: Measure,
    #[command(flatten)]
    filter: Filter,
}

impl Verb for Rank {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let record = record::read(&self.record)?;
        let cells = record.cells.iter().filter(|c| self.filter.takes_with(&self.to, c));
        let ranking = rank(cells, &self.to, self.measure)
            .map_err(|error| Error::usage(error.to_string(), "`rayscale cmp` shows what the record holds"))?;
        console.result(&ranking, text(&ranking))?;
        Ok(Outcome::Done)
    }
}

fn text(ranking: &Ranking) -> String {
    let mut out = format!(
        "{} to {}: geometric mean of ratios over {}",
        ranking.measure.what(),
        ranking.to,
        if ranking.shared == 1 {
            "the one shared cell".to_owned()
        } else {
            format!("{} shared cells", ranking.shared)
        }
    );
    if ranking.left_out > 0 {
        let lacking = ranking.lacking.join(", ");
        let _ = write!(
            out,
            "\nleft out: {} cells in which {lacking} has no figure; --rays and --structure choose what is ranked",
            ranking.left_out
        );
    }
    let rows: Vec<Vec<String>> = ranking
        .places
        .iter()
        .map(|place| {
            let range = format!("({} to {})", ratio(place.least), ratio(place.most));
            vec![format!("  {}", place.structure), ratio(place.ratio), range]
        })
        .collect();
    let _ = write!(out, "\n{}", in_columns(&rows, &[false, true, false]));
    out
}
