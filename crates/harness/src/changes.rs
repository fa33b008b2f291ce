//! What changed from one record to another, and what is only noise.
//!
//! A disturbance (other work on the same core, a change of clock) only ever makes a sample longer, it lasts longer than a
//! sample, and it slows some structures more than others. And each pass builds anew: a structure that happens to lie well in
//! memory is faster for that pass, in all its cells. So samples come from several passes over the scene, and a cell's figure
//! is either its least sample, which one pass left in peace is enough for, or the middle of its passes' least, which one lucky
//! build does not change: whichever is known better by a bootstrap over raw samples that draws whole passes. What two
//! runs differ by besides (memory is laid out anew, the machine is warmer or busy all the time) no record can know of
//! itself. The *other* structures' cells in the same two records do: by the middle of their ratios (the drift) and how far they
//! spread about it, all of them and those on the same rays, whose samples were taken at the same time.
//!
//! A structure is judged as a whole too, by the middle of its cells' ratios, against those of the other structures:
//! noise of single cells averages out, so that a smaller change is beyond it.

mod figure;

use crate::record::{Cell, Key, Record};
use crate::stats::median;
use figure::{DRAWS, figures, reach};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Everything that two records share.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Changes {
    /// Structures as a whole.
    pub structures: Vec<Shift>,
    /// Every cell.
    pub cells: Vec<Change>,
}

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
    /// The change.
    #[serde(flatten)]
    pub judged: Judged,
}

/// A structure's change over all its cells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shift {
    /// Structure.
    pub structure: String,
    /// Cells that both records have of it.
    pub cells: usize,
    /// The change: that of the middle cell.
    #[serde(flatten)]
    pub judged: Judged,
}

/// A ratio and whether it means anything.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// The second's time per ray over the first's.
    pub ratio: f64,
    /// Middle of the ratios of the other structures; 1 if there are too few to tell.
    pub drift: f64,
    /// Range of the ratio over the drift that noise alone explains, about what was seen.
    pub low: f64,
    /// As above.
    pub high: f64,
    /// Whether the range leaves out 1.
    pub beyond_noise: bool,
}

/// Widths of ranges in spreads: among the hundreds of cells of a record hardly any is that far out by chance, and
/// single cells have heavier tails than structures.
const CELL_SPREADS: f64 = 5.0;
const STRUCTURE_SPREADS: f64 = 3.5;
/// The spread of log ratios that is expected before any is seen, and how many that counts for.
const EXPECTED: (f64, f64) = (0.02, 4.0);
/// With fewer than this of other structures, or of their cells, there is no telling a drift.
const ENOUGH_STRUCTURES: usize = 3;
const ENOUGH_CELLS: usize = 8;
/// Makes the median deviation of normal noise its standard deviation.
const NORMAL: f64 = 1.4826;
/// Standard error of the median of normal noise, over that of the mean.
const MEDIAN_ERROR: f64 = 1.25;

/// A cell that both records have.
struct Pair<'a> {
    cell: &'a Cell,
    /// Logarithm of the ratio of least samples.
    log: f64,
    /// How well the passes of both runs agree on it.
    own: f64,
    /// It in draws of their passes.
    drawn: Vec<f64>,
}

/// Changes of time per ray from record `a` to `b`, over the cells that both have.
pub fn changes(a: &Record, b: &Record) -> Changes {
    let name = |cell: &Cell| (cell.key(), cell.structure.clone(), cell.kernel.clone(), cell.query);
    let first: BTreeMap<_, &Cell> = a.cells.iter().map(|cell| (name(cell), cell)).collect();
    let scenes: BTreeSet<&str> = b.cells.iter().map(|cell| cell.scene.as_str()).collect();
    let scenes: BTreeMap<&str, usize> = scenes.into_iter().zip(0..).collect();
    let pair = |cell| Pair::of(first.get(&name(cell)).copied()?, cell, scenes[cell.scene.as_str()]);
    let pairs: Vec<Pair> = b.cells.iter().filter_map(pair).collect();
    let mut of_structures: BTreeMap<&str, Vec<&Pair>> = BTreeMap::new();
    for pair in &pairs {
        of_structures.entry(&pair.cell.structure).or_default().push(pair);
    }
    let logs = |pairs: &[&Pair]| pairs.iter().map(|pair| pair.log).collect();
    let logs: BTreeMap<&str, Vec<f64>> = of_structures.iter().map(|(id, pairs)| (*id, logs(pairs))).collect();
    let middles: BTreeMap<&str, f64> =
        logs.iter().map(|(id, logs)| (*id, median(logs).unwrap_or(0.0))).collect();
    let others =
        |id: &str| Between::of(logs.iter().filter(|(o, _)| **o != id).flat_map(|(_, l)| l), ENOUGH_CELLS);
    let others: BTreeMap<&str, Between> = logs.keys().map(|id| (*id, others(id))).collect();
    let structures = logs.iter().map(|(id, logs)| {
        let among = Between::of(middles.iter().filter(|(o, _)| *o != id).map(|(_, m)| m), ENOUGH_STRUCTURES);
        let error = MEDIAN_ERROR * others[id].with(logs, middles[id]) / (logs.len() as f64).sqrt();
        let own = own_error(&of_structures[id], middles[id]);
        let judged = among.judge(middles[id], error.hypot(own), STRUCTURE_SPREADS);
        Shift { structure: (*id).to_owned(), cells: logs.len(), judged }
    });
    let mut sets: BTreeMap<Key, Vec<&Pair>> = BTreeMap::new();
    for pair in &pairs {
        sets.entry(pair.cell.key()).or_default().push(pair);
    }
    let cells = pairs.iter().map(|pair| {
        let others = others[pair.cell.structure.as_str()];
        let beside = sets[&pair.cell.key()].iter().filter(|p| p.cell.structure != pair.cell.structure);
        let beside: Vec<f64> = beside.map(|p| p.log).collect();
        let at_once = if beside.len() < ENOUGH_STRUCTURES { 0.0 } else { deviation(&beside, others.drift) };
        Change {
            scene: pair.cell.scene.clone(),
            rays: pair.cell.rays.clone(),
            structure: pair.cell.structure.clone(),
            threads: pair.cell.threads,
            judged: others.judge(pair.log, pair.own.hypot(at_once), CELL_SPREADS),
        }
    });
    Changes { structures: structures.collect(), cells: cells.collect() }
}

impl<'a> Pair<'a> {
    /// `scene` tells scenes apart: those of one have their passes in common.
    fn of(before: &Cell, cell: &'a Cell, scene: usize) -> Option<Self> {
        let seed = 2 * scene as u64;
        let (a, b) = (figures(before, seed)?, figures(cell, seed + 1)?);
        let pairs = a.into_iter().zip(b).map(|(a, b)| Self {
            cell,
            log: b.log - a.log,
            own: a.error().hypot(b.error()),
            drawn: a.drawn.iter().zip(&b.drawn).map(|(a, b)| b - a).collect(),
        });
        pairs.min_by(|one, other| one.own.total_cmp(&other.own))
    }
}

/// How far the middle of a structure's cells is known: their passes are drawn together, as other work disturbs and
/// a lucky build favours many of them at once.
fn own_error(pairs: &[&Pair], middle: f64) -> f64 {
    let draw = |k: usize| median(&pairs.iter().map(|pair| pair.drawn[k]).collect::<Vec<_>>());
    let drawn: Vec<f64> = (0..DRAWS).filter_map(draw).collect();
    reach(&drawn, middle)
}

/// How the ratios of others lie between two records, as logarithms.
#[derive(Clone, Copy)]
struct Between {
    drift: f64,
    /// Spread as seen, and over how many.
    seen: (f64, f64),
    /// Spread as seen and expected.
    spread: f64,
}

impl Between {
    fn of<'a>(logs: impl Iterator<Item = &'a f64>, enough: usize) -> Self {
        let logs: Vec<f64> = logs.copied().collect();
        let middle = median(&logs).unwrap_or(0.0);
        let seen = deviation(&logs, middle);
        let ((expected, weight), n) = (EXPECTED, logs.len() as f64);
        let variance = (weight * expected * expected + n * seen * seen) / (weight + n);
        let drift = if logs.len() < enough { 0.0 } else { middle };
        Self { drift, seen: (seen, n), spread: variance.sqrt() }
    }

    /// The spread as seen, with more figures about a middle of their own. A few have little weight: two cells that happen to
    /// lie apart do not make a structure's figure unknown.
    fn with(self, logs: &[f64], middle: f64) -> f64 {
        let ((seen, n), more) = (self.seen, logs.len() as f64 - 1.0);
        if n + more <= 0.0 {
            return 0.0;
        }
        ((n * seen * seen + more * deviation(logs, middle).powi(2)) / (n + more)).sqrt()
    }

    /// Judges a log ratio whose own error is known.
    fn judge(self, log: f64, error: f64, spreads: f64) -> Judged {
        let (relative, width) = (log - self.drift, spreads * self.spread.hypot(error));
        Judged {
            ratio: log.exp(),
            drift: self.drift.exp(),
            low: (relative - width).exp(),
            high: (relative + width).exp(),
            beyond_noise: relative.abs() > width,
        }
    }
}

impl Judged {
    /// The ratio over the drift: what the range is about.
    pub fn relative(&self) -> f64 {
        self.ratio / self.drift
    }
}

/// Standard deviation about a middle, by the median deviation.
fn deviation(logs: &[f64], middle: f64) -> f64 {
    let deviations: Vec<f64> = logs.iter().map(|log| (log - middle).abs()).collect();
    NORMAL * median(&deviations).unwrap_or(0.0)
}

#[cfg(test)]
mod tests;
