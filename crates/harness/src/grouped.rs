//! Ratios over cells: rankings. Build time, trace time and memory are never mixed.

use crate::record::{Cell, Key};
use crate::stats::geometric_mean;
use serde::Serialize;
use std::collections::BTreeMap;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// Time per ray.
    Trace,
    /// Time to build.
    Build,
    /// Bytes that the method adds.
    Structure,
    /// Bytes in all, copied geometry included.
    Bytes,
}

impl Measure {
    /// The cell's figure: median ns per ray, median ns of a build, or bytes. None for cells
    /// that failed, and for zero bytes, which have no ratio.
    pub fn of(self, cell: &Cell) -> Option<f64> {
        let bytes = cell.bytes.as_ref().filter(|_| cell.outcome.is_measured());
        let figure = match self {
            Self::Trace => cell.ns(),
            Self::Build => cell.build(),
            Self::Structure => bytes.map(|b| b.structure as f64),
            Self::Bytes => bytes.map(|b| b.structure.saturating_add(b.geometry_copy) as f64),
        };
        figure.filter(|value| *value > 0.0)
    }

    /// What is compared, in words.
    pub const fn what(self) -> &'static str {
        match self {
            Self::Trace => "time per ray",
            Self::Build => "build time",
            Self::Structure => "structure bytes",
            Self::Bytes => "all bytes",
        }
    }
}

/// Structures by the geometric mean of their ratios to one of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranking {
    /// What is compared.
    pub measure: Measure,
    /// The structure that all ratios are to.
    pub to: String,
    /// The structures without a figure in some cells.
    pub lacking: Vec<String>,
    /// Number of cells (scene × ray set × threads) in which all structures have a figure.
    pub shared: usize,
    /// Cells left out because some structure has none.
    pub left_out: usize,
    /// From the least ratio on.
    pub places: Vec<Place>,
}

/// A place in a ranking.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// The structure.
    pub structure: String,
    /// Geometric mean of figure / figure of the named structure.
    pub ratio: f64,
    /// Least ratio and the greatest.
    pub least: f64,
    /// As above.
    pub most: f64,
}

/// Why there is no ranking.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RankError {
    /// The record has no such structure among its cells.
    #[error("the record has no cell of structure `{0}` there")]
    NoStructure(String),
    /// No cell in which all have a figure.
    #[error("there is no cell in which all of these structures have a figure: {0}")]
    NothingShared(String),
}

/// Ranks the structures that have a figure in any of the `cells`, by ratios to `to` over the cells
/// that all of them share.
///
/// # Errors
/// Where `to` has no figure, or nothing is shared.
pub fn rank<'a>(
    cells: impl Iterator<Item = &'a Cell>,
    to: &str,
    measure: Measure,
) -> Result<Ranking, RankError> {
    let mut structures: Vec<&str> = Vec::new();
    let mut table: BTreeMap<Key, BTreeMap<&str, f64>> = BTreeMap::new();
    for cell in cells {
        let Some(figure) = measure.of(cell) else { continue };
        if !structures.contains(&cell.structure.as_str()) {
            structures.push(&cell.structure);
        }
        table.entry(cell.key()).or_default().insert(&cell.structure, figure);
    }
    if !structures.contains(&to) {
        return Err(RankError::NoStructure(to.to_owned()));
    }
    let all = table.len();
    let lacks = |structure: &&&str| table.values().any(|row| !row.contains_key(**structure));
    let lacking = structures.iter().filter(lacks).map(|s| (*s).to_owned()).collect();
    table.retain(|_, row| row.len() == structures.len());
    if table.is_empty() {
        return Err(RankError::NothingShared(structures.join(", ")));
    }
    let mut places: Vec<Place> = structures
        .iter()
        .filter_map(|structure| {
            let ratios: Vec<f64> = table.values().map(|row| row[structure] / row[to]).collect();
            Some(Place {
                structure: (*structure).to_owned(),
                ratio: geometric_mean(&ratios)?,
                least: ratios.iter().copied().fold(f64::INFINITY, f64::min),
                most: ratios.iter().copied().fold(0.0, f64::max),
            })
        })
        .collect();
    places.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let (shared, left_out) = (table.len(), all - table.len());
    Ok(Ranking { measure, to: to.to_owned(), shared, left_out, lacking, places })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn rankings_use_the_cells_that_all_share() {
        let record = testing::record();
        let ranking = rank(record.cells.iter(), "a", Measure::Trace).unwrap();
        // c failed on one of four cells: that cell counts for nobody.
        assert_eq!((ranking.shared, ranking.left_out), (3, 1));
        assert_eq!(ranking.lacking, ["c"]);
        let order: Vec<_> = ranking.places.iter().map(|p| p.structure.as_str()).collect();
        assert_eq!(order, ["c", "a", "b"]);
        assert!((ranking.places[2].ratio - 2.0).abs() < 1e-3);
        assert!((ranking.places[0].ratio - 0.5).abs() < 1e-3);
        assert_eq!(ranking.places[1].ratio, 1.0);
    }

    #[test]
    fn one_figure_is_never_mixed_with_another() {
        let record = testing::record();
        let build = rank(record.cells.iter(), "a", Measure::Build).unwrap();
        assert!(build.places.iter().all(|place| place.ratio == 1.0), "all builds take equally long");
        let bytes = rank(record.cells.iter(), "a", Measure::Bytes).unwrap();
        assert!(bytes.places.iter().all(|place| place.ratio == 1.0));
    }

    #[test]
    fn what_can_not_be_ranked_is_said() {
        let record = testing::record();
        let unknown = rank(record.cells.iter(), "x", Measure::Trace);
        assert_eq!(unknown, Err(RankError::NoStructure("x".into())));
        let apart = [testing::cell("one", "r", "a", 1.0), testing::cell("two", "r", "b", 1.0)];
        assert!(matches!(rank(apart.iter(), "a", Measure::Trace), Err(RankError::NothingShared(_))));
    }
}
