//! Figures over scenes: geometric means over the cells that all compared structures share.

use harness::record::{Cell, Record};
use harness::stats::geometric_mean;
use std::collections::{BTreeMap, BTreeSet};

/// One ray set over all scenes, at one number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Overall<'r> {
    /// The ray set.
    pub rays: &'r str,
    /// The scenes that all rows share.
    pub scenes: Vec<&'r str>,
    /// The structures, the fastest first.
    pub rows: Vec<Row<'r>>,
    /// Structures without figures on too many scenes, with the number of scenes they have.
    pub left_out: Vec<(&'r str, usize)>,
}

/// A structure's geometric means.
#[derive(Clone, Debug, PartialEq)]
pub struct Row<'r> {
    /// The structure.
    pub structure: &'r str,
    /// Time for a ray in ns.
    pub ns: f64,
    /// Bytes for an object, of structure and geometry copy.
    pub bytes: Option<f64>,
    /// Its cells on the shared scenes.
    pub cells: Vec<&'r Cell>,
}

/// A structure takes part in a comparison if it has figures on at least this share of the scenes.
const SHARE: f64 = 0.7;

/// The least number of threads of any cell: the figure that reports quote first.
pub fn threads(record: &Record) -> usize {
    record.cells.iter().map(|cell| cell.threads).min().unwrap_or(1)
}

/// Every ray set over all scenes, in the record's order.
pub fn overall(record: &Record, threads: usize) -> Vec<Overall<'_>> {
    record.ray_sets().into_iter().filter_map(|rays| over_scenes(record, rays, threads)).collect()
}

fn over_scenes<'r>(record: &'r Record, rays: &'r str, threads: usize) -> Option<Overall<'r>> {
    let mut cells: BTreeMap<&str, BTreeMap<&str, &Cell>> = BTreeMap::new();
    for cell in record.cells.iter().filter(|c| c.rays == rays && c.threads == threads && c.ns().is_some()) {
        cells.entry(&cell.structure).or_default().insert(&cell.scene, cell);
    }
    let all: BTreeSet<&str> = cells.values().flat_map(|scenes| scenes.keys().copied()).collect();
    let enough = |scenes: usize| scenes as f64 >= SHARE * all.len() as f64;
    let (kept, few): (Vec<_>, Vec<_>) = cells.into_iter().partition(|(_, scenes)| enough(scenes.len()));
    let shared: Vec<&str> = record
        .scenes
        .iter()
        .map(|scene| scene.id.as_str())
        .filter(|scene| !kept.is_empty() && kept.iter().all(|(_, scenes)| scenes.contains_key(scene)))
        .collect();
    let mut rows: Vec<Row> = kept
        .iter()
        .filter_map(|(structure, scenes)| {
            let cells: Vec<&Cell> = shared.iter().map(|scene| scenes[scene]).collect();
            let ns: Option<Vec<f64>> = cells.iter().map(|cell| cell.ns()).collect();
            let bytes: Option<Vec<f64>> = cells.iter().map(|cell| bytes_per_object(record, cell)).collect();
            Some(Row {
                structure,
                ns: geometric_mean(&ns?)?,
                bytes: bytes.and_then(|bytes| geometric_mean(&bytes)),
                cells,
            })
        })
        .collect();
    rows.sort_by(|a, b| a.ns.total_cmp(&b.ns));
    let left_out = few.into_iter().map(|(structure, scenes)| (structure, scenes.len())).collect();
    (!rows.is_empty()).then_some(Overall { rays, scenes: shared, rows, left_out })
}

/// Bytes of structure and geometry copy for each object of the scene. A structure that holds
/// nothing counts as one byte, so that it has a place on a logarithmic scale.
pub fn bytes_per_object(record: &Record, cell: &Cell) -> Option<f64> {
    let bytes = cell.bytes.as_ref()?;
    let objects = record.scene(&cell.scene)?.objects.max(1);
    Some((bytes.structure + bytes.geometry_copy).max(1) as f64 / objects as f64)
}

/// The Pareto front: which of the points `(a, b)` no other point beats in one figure without
/// losing in the other (less is better); the indices sorted by the first figure.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|i, j| {
        let ((a, b), (c, d)) = (points[*i], points[*j]);
        a.total_cmp(&c).then(b.total_cmp(&d))
    });
    let mut best = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i].1 < best;
        best = best.min(points[*i].1);
        better
    });
    order
}

/// A stretch of ray counts on which one structure is first with its image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The structure's index.
    pub winner: usize,
    /// From how many rays on.
    pub from: f64,
}

/// Who is first as rays grow from 0, by `(build ns, ns per ray)` of each structure: the lower
/// envelope of the lines `build + ns·rays`.
pub fn envelope(lines: &[(f64, f64)]) -> Vec<Stretch> {
    let at_zero = |(i, line): (usize, &(f64, f64))| (line.0, line.1, i);
    let order = |a: &(f64, f64, usize), b: &(f64, f64, usize)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
    let Some((_, _, mut winner)) = lines.iter().enumerate().map(at_zero).min_by(order) else {
        return Vec::new();
    };
    let mut stretches = vec![Stretch { winner, from: 0.0 }];
    loop {
        let (build, ns) = lines[winner];
        // Of those that gain on the winner, the one that meets it first; of these the fastest.
        let next = lines
            .iter()
            .enumerate()
            .filter(|(_, line)| line.1 < ns)
            .map(|(i, line)| ((line.0 - build) / (ns - line.1), line.1, i))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let Some((from, _, i)) = next else { return stretches };
        winner = i;
        stretches.push(Stretch { winner, from });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::testing;
    use proptest::prelude::*;

    #[test]
    fn only_shared_cells_count() {
        let record = testing::record();
        let all = overall(&record, 1);
        let parallel = all.iter().find(|o| o.rays == "parallel").unwrap();
        assert_eq!(parallel.scenes, ["one", "two"]);
        assert_eq!(parallel.rows[0].structure, "c");
        // 5 ns on one scene, 20 on the other: 10 in the geometric mean.
        assert!((parallel.rows[0].ns - 10.0).abs() < 0.01);
        // c failed on one of two scenes with random rays: too few to take part.
        let random = all.iter().find(|o| o.rays == "random").unwrap();
        assert_eq!(random.left_out, [("c", 1)]);
        assert_eq!(random.rows.iter().map(|row| row.structure).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(random.scenes.len(), 2);
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        assert_eq!(front(&[(1.0, 9.0), (2.0, 5.0), (3.0, 6.0), (4.0, 1.0), (2.0, 7.0)]), [0, 1, 3]);
        assert_eq!(front(&[]), [0; 0]);
    }

    #[test]
    fn who_is_first_as_rays_grow() {
        // 0: no build, slow; 1: between; 2: long build, fast; 3: never first.
        let lines = [(0.0, 10.0), (100.0, 5.0), (1000.0, 1.0), (900.0, 6.0)];
        let stretches = envelope(&lines);
        assert_eq!(stretches.iter().map(|s| s.winner).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(stretches.iter().map(|s| s.from).collect::<Vec<_>>(), [0.0, 20.0, 225.0]);
    }

    proptest! {
        #[test]
        fn the_envelope_is_below_all(lines in prop::collection::vec((0.0..1e6f64, 0.1..1e3f64), 1..9), rays in 0.0..1e5f64) {
            let stretches = envelope(&lines);
            let winner = stretches.iter().rev().find(|s| s.from <= rays).unwrap().winner;
            let time = |(build, ns): (f64, f64)| build + ns * rays;
            let best = lines.iter().map(|line| time(*line)).fold(f64::INFINITY, f64::min);
            prop_assert!(time(lines[winner]) <= best * (1.0 + 1e-9));
        }
    }
}
