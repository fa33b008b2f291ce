//! What a cell's time per ray is, and how well its passes know it.

use crate::record::Cell;
use crate::stats::{cluster_bootstrap, least, median, quantile};

/// Draws of the bootstrap.
pub const DRAWS: usize = 500;
/// Passes from which on one of them does not change the middle.
const ENOUGH_PASSES: usize = 3;
/// Of normal noise this share lies below one standard deviation.
const ONE_DEVIATION: f64 = 0.84;

/// Logarithm of a time per ray, as it came out and as it might as well have, by a cluster bootstrap over passes.
pub struct Figure {
    /// As it came out.
    pub log: f64,
    /// As drawn.
    pub drawn: Vec<f64>,
}

/// The least sample of a cell that did not fail and, of enough passes, the middle of their least. Draws of one `seed` are
/// of the same passes in all cells that have as many.
pub fn figures(cell: &Cell, seed: u64) -> Option<Vec<Figure>> {
    cell.ns()?;
    let mut passes = cell.passes_per_ray();
    passes.retain(|pass| !pass.is_empty());
    let leasts = |passes: &[Vec<f64>]| -> Vec<f64> { passes.iter().map(|pass| least(pass)).collect() };
    let of_all = |passes: &[Vec<f64>]| least(&leasts(passes));
    let middle = |passes: &[Vec<f64>]| median(&leasts(passes)).unwrap_or(f64::NAN);
    let mut figures = vec![Figure::of(&passes, seed, of_all)?];
    if passes.len() >= ENOUGH_PASSES {
        figures.push(Figure::of(&passes, seed, middle)?);
    }
    Some(figures)
}

impl Figure {
    fn of(passes: &[Vec<f64>], seed: u64, statistic: impl Fn(&[Vec<f64>]) -> f64) -> Option<Self> {
        let log = statistic(passes).ln();
        let drawn = cluster_bootstrap(passes, DRAWS, seed, statistic).into_iter().map(f64::ln).collect();
        let figure = Self { log, drawn };
        (log.is_finite() && figure.error().is_finite()).then_some(figure)
    }

    /// How far it is known: a standard deviation's worth.
    pub fn error(&self) -> f64 {
        reach(&self.drawn, self.log)
    }
}

/// How far draws lie to either side of what came out: a standard deviation's worth.
pub fn reach(drawn: &[f64], came_out: f64) -> f64 {
    let quantile = |q: f64| quantile(drawn, q).unwrap_or(f64::NAN);
    (quantile(ONE_DEVIATION) - came_out).max(came_out - quantile(1.0 - ONE_DEVIATION))
}
