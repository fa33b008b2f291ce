//! What changed from one record to another, and what is only noise.
//!
//! Samples of one run agree better with each other than with those of another run: memory is laid out anew, the machine
//! is warmer or busier. An interval from the samples of a cell alone would find changes where there are none. So the
//! ratio of a cell is taken relative to the middle of the ratios of the *other* structures' cells between the same two
//! records (the drift), and its interval is widened by how far those spread.

use crate::record::{Cell, Record};
use crate::stats::{Interval, median, ratio_interval};
use serde::Serialize;
use std::collections::BTreeMap;

/// A cell's change from one record to another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Scene.
    pub scene: String,
    /// Ray set.
    pub rays: String,
    /// Structure.
    pub structure: String,
    /// Threads.
    pub threads: usize,
    /// Median of the second over median of the first.
    pub ratio: f64,
    /// Middle of the ratios of the other structures' cells; 1 if there are too few to tell.
    pub drift: f64,
    /// Interval of the ratio over the drift: bootstrap over the raw samples at 99 %, widened as the module says.
    pub low: f64,
    /// As above.
    pub high: f64,
    /// Whether the interval leaves out 1.
    pub beyond_noise: bool,
}

/// Confidence of the bootstrap.
const CONFIDENCE: f64 = 0.99;
/// Draws of the bootstrap.
const DRAWS: usize = 1000;
/// The interval is widened by so many spreads of the other cells: among the hundreds of cells of a record hardly any
/// is that far out by chance.
const SPREADS: f64 = 4.0;
/// The spread of log ratios that is expected before any cell is seen, and how many cells that counts for.
const EXPECTED: (f64, f64) = (0.02, 4.0);

/// With fewer cells of other structures than this there is no telling a drift.
const ENOUGH: usize = 8;

/// Changes of time per ray from record `a` to `b`, over the cells that both have.
pub fn changes(a: &Record, b: &Record) -> Vec<Change> {
    let name = |cell: &Cell| (cell.key(), cell.structure.clone(), cell.kernel.clone(), cell.query);
    let first: BTreeMap<_, &Cell> = a.cells.iter().map(|cell| (name(cell), cell)).collect();
    let pairs: Vec<(&Cell, &Cell, f64)> = b
        .cells
        .iter()
        .filter_map(|after| {
            let before = *first.get(&name(after))?;
            Some((before, after, (after.ns()? / before.ns()?).ln()))
        })
        .collect();
    let mut between: BTreeMap<&str, Between> = BTreeMap::new();
    for (_, cell, _) in &pairs {
        between.entry(&cell.structure).or_insert_with(|| {
            let others = pairs.iter().filter(|(_, other, _)| other.structure != cell.structure);
            Between::of(&others.map(|(_, _, log)| *log).collect::<Vec<_>>())
        });
    }
    pairs
        .iter()
        .map(|(before, after, log)| change(before, after, *log, between[after.structure.as_str()]))
        .collect()
}

/// How the ratios of other cells lie between two records, as logarithms.
#[derive(Clone, Copy)]
struct Between {
    drift: f64,
    spread: f64,
}

impl Change {
    /// The ratio over the drift: what the interval is about.
    pub fn relative(&self) -> f64 {
        self.ratio / self.drift
    }
}

impl Between {
    fn of(logs: &[f64]) -> Self {
        let drift = median(logs).unwrap_or(0.0);
        let deviations: Vec<f64> = logs.iter().map(|log| (log - drift).abs()).collect();
        // The factor makes the median deviation of normal noise its standard deviation.
        let seen = 1.4826 * median(&deviations).unwrap_or(0.0);
        let (expected, weight) = EXPECTED;
        let n = logs.len() as f64;
        let variance = (weight * expected * expected + n * seen * seen) / (weight + n);
        let drift = if logs.len() < ENOUGH { 0.0 } else { drift };
        Self { drift, spread: variance.sqrt() }
    }
}

fn change(a: &Cell, b: &Cell, log: f64, between: Between) -> Change {
    let interval = ratio_interval(&b.samples_per_ray(), &a.samples_per_ray(), CONFIDENCE, DRAWS, 1);
    let interval = interval.unwrap_or(Interval { low: 0.0, high: f64::INFINITY });
    let widen = |end: f64| (end.ln() - log).hypot(SPREADS * between.spread);
    let relative = log - between.drift;
    let interval = Interval {
        low: (relative - widen(interval.low)).exp(),
        high: (relative + widen(interval.high)).exp(),
    };
    Change {
        scene: b.scene.clone(),
        rays: b.rays.clone(),
        structure: b.structure.clone(),
        threads: b.threads,
        ratio: log.exp(),
        drift: between.drift.exp(),
        low: interval.low,
        high: interval.high,
        beyond_noise: !interval.contains(1.0),
    }
}

#[cfg(test)]
mod tests;
