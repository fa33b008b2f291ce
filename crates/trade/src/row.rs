//! Rows of the trade: time, memory and errors side by side.

use crate::{Accuracy, Judged};
use harness::front::front;
use harness::record::{Intersector, Outcome};
use serde::{Deserialize, Serialize};

/// A structure with a kernel on a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TradeRow {
    /// Scene.
    pub scene: String,
    /// Structure with its settings.
    pub structure: String,
    /// Ray-triangle intersector.
    pub kernel: Intersector,
    /// Why this kernel was chosen, where that was left to the suite.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kernel_reason: String,
    /// Geometric mean over the timed ray sets, unless one of them failed.
    pub ns_per_ray: Option<f64>,
    /// Memory of structure and geometry copy.
    pub bytes: Option<u64>,
    /// Errors on ordinary rays, all sets together; none where nothing could be judged, and in records of old.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ordinary: Option<Judged>,
    /// Errors on rays that hunt for errors, likewise; never mixed with the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hunting: Option<Judged>,
    /// The same set by set, ordinary ones first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sets: Vec<Judged>,
    /// Errors as records of old have them, of a mixture of ordinary and hunting sets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Whether no other row of the scene is as fast and as right on ordinary rays, and better in one of them.
    pub front: bool,
    /// Whether its times and errors are known, and why not.
    #[serde(flatten)]
    pub outcome: Outcome,
}

impl TradeRow {
    /// ns per ray and errors in a million rays, where both are known: visible errors on ordinary rays, or what a record of old
    /// has.
    pub fn point(&self) -> Option<(f64, f64)> {
        let errors = match (&self.ordinary, &self.accuracy) {
            (Some(ordinary), _) => ordinary.visible_per_million(),
            (None, Some(accuracy)) => accuracy.errors_per_million(),
            (None, None) => return None,
        };
        Some((self.ns_per_ray?, errors))
    }

    /// Whether its kernel is the exact one.
    pub fn is_exact(&self) -> bool {
        self.kernel == Intersector::BuiltIn(primitives::KernelId::Exact)
    }
}

/// Marks the Pareto front of the rows of one scene.
pub fn mark_front(rows: &mut [TradeRow]) {
    let (known, points): (Vec<usize>, Vec<_>) =
        rows.iter().enumerate().filter_map(|(i, row)| Some((i, row.point()?))).unzip();
    rows.iter_mut().for_each(|row| row.front = false);
    for i in front(&points) {
        rows[known[i]].front = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let row = |ns: f64, missed: u64| TradeRow {
            scene: "s".into(),
            structure: "x".into(),
            kernel: Intersector::External,
            kernel_reason: String::new(),
            ns_per_ray: Some(ns),
            bytes: None,
            ordinary: None,
            hunting: None,
            sets: Vec::new(),
            accuracy: Some(Accuracy { rays: 100, missed, ..Accuracy::default() }),
            front: false,
            outcome: Outcome::Measured,
        };
        let mut rows = [row(1.0, 5), row(2.0, 5), row(2.0, 1), row(3.0, 0), row(4.0, 0)];
        rows[4].ns_per_ray = None;
        mark_front(&mut rows);
        assert_eq!(rows.map(|row| row.front), [true, false, true, true, false]);
    }
}
