//! `rayscale rank`: geometric means of ratios.

use super::{Console, Error, Outcome, Verb};
use crate::grouped::{Measure, Ranking, rank};
use crate::record::{self, Cell};
use clap::Args;
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
    #[arg(long, value_enum, default_value_t = Measure::Trace)]
    measure: Measure,
    #[command(flatten)]
    filter: Filter,
}

/// Which cells of a record.
#[derive(Clone, Debug, Default, Args)]
pub struct Filter {
    /// Only these scenes
    #[arg(long = "scene", value_name = "SCENE", value_delimiter = ';')]
    scenes: Vec<String>,
    /// Only these ray sets
    #[arg(long, value_name = "RAYS", value_delimiter = ',')]
    rays: Vec<String>,
    /// Only these structures
    #[arg(long = "structure", value_name = "ID")]
    structures: Vec<String>,
}

impl Filter {
    /// Whether a cell passes.
    pub fn takes(&self, cell: &Cell) -> bool {
        let among = |names: &[String], name: &str| names.is_empty() || names.iter().any(|n| n == name);
        among(&self.scenes, &cell.scene)
            && among(&self.rays, &cell.rays)
            && among(&self.structures, &cell.structure)
    }
}

impl Verb for Rank {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let record = record::read(&self.record)?;
        let cells = record.cells.iter().filter(|c| self.filter.takes(c) || c.structure == self.to);
        let cells = cells.filter(|c| Filter { structures: Vec::new(), ..self.filter.clone() }.takes(c));
        let ranking = rank(cells, &self.to, self.measure)
            .map_err(|error| Error::usage(error.to_string(), "`rayscale cmp` shows what the record holds"))?;
        console.result(&ranking, text(&ranking).trim_end())?;
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
    out.push('\n');
    let width = ranking.places.iter().map(|p| p.structure.len()).max().unwrap_or(0);
    for place in &ranking.places {
        let _ = writeln!(
            out,
            "  {:width$}  {:8.3}   ({:.3} to {:.3})",
            place.structure, place.ratio, place.least, place.most
        );
    }
    out
}
