//! Figures over scenes: geometric means over the cells that all compared structures share.

use harness::record::{Cell, Record};
use harness::stats::geometric_mean;
use std::collections::{BTreeMap, BTreeSet};

/// Ray sets over all scenes, at one number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Overall<'r> {
    /// The ray set or sets, in a word.
    pub rays: &'r str,
    /// Number of scenes in what all rows share.
    pub scenes: usize,
    /// Number of ray sets in it.
    pub sets: usize,
    /// The structures, the fastest first.
    pub rows: Vec<MeanRow<'r>>,
    /// Structures without figures on too many cells, with the number of those that they have.
    pub left_out: Vec<(&'r str, usize)>,
}

/// A structure's geometric means.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanRow<'r> {
    /// The structure.
    pub structure: &'r str,
    /// Time for a ray in ns.
    pub ns: f64,
    /// Bytes for an object, of structure and geometry copy.
    pub bytes: Option<f64>,
    /// Its cells that all share.
    pub cells: Vec<&'r Cell>,
}

/// A structure takes part in a comparison if it has figures on at least this share of the cells.
const SHARE: f64 = 0.7;

/// The least number of threads of any cell: the figure that reports quote first.
pub fn threads(record: &Record) -> usize {
    record.cells.iter().map(|cell| cell.threads).min().unwrap_or(1)
}

/// Every ray set over all scenes, in the record's order.
pub fn overall(record: &Record, threads: usize) -> Vec<Overall<'_>> {
    let sets = record.ray_sets().into_iter();
    sets.filter_map(|rays| over(record, rays, threads, |cell| cell.rays == rays)).collect()
}

/// All images, and all lists of rays, where there is more than one set of them.
pub fn by_kind(record: &Record, threads: usize) -> Vec<Overall<'_>> {
    let kinds = [("images", true), ("lists of rays", false)];
    let over = |(name, images)| over(record, name, threads, |cell| cell.is_image() == images);
    kinds.into_iter().filter_map(over).filter(|kind| kind.sets > 1).collect()
}

impl<'r> Overall<'r> {
    /// What others are held against: Embree where it was measured, else the fastest.
    pub fn reference(&self) -> Option<&MeanRow<'r>> {
        self.rows.iter().find(|row| row.structure == "embree").or(self.rows.first())
    }

    /// What the means are over.
    pub fn extent(&self) -> String {
        let of = |n: usize, one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
        match self.sets {
            1 => of(self.scenes, "scene"),
            sets => format!("{} and {}", of(self.scenes, "scene"), of(sets, "ray set")),
        }
    }
}

fn over<'r>(
    record: &'r Record,
    name: &'r str,
    threads: usize,
    takes: impl Fn(&Cell) -> bool,
) -> Option<Overall<'r>> {
    let taken = |c: &&Cell| takes(c) && c.threads == threads && c.ns().is_some();
    let mut cells: BTreeMap<&str, BTreeMap<(&str, &str), &Cell>> = BTreeMap::new();
    for cell in record.cells.iter().filter(taken) {
        cells.entry(&cell.structure).or_default().insert((&cell.scene, &cell.rays), cell);
    }
    let all: BTreeSet<_> = cells.values().flat_map(|of| of.keys().copied()).collect();
    let enough = |n: usize| n as f64 >= SHARE * all.len() as f64;
    let (kept, few): (Vec<_>, Vec<_>) = cells.into_iter().partition(|(_, of)| enough(of.len()));
    let is_shared = |key: &(&str, &str)| kept.iter().all(|(_, of)| of.contains_key(key));
    let shared: Vec<_> = all.into_iter().filter(is_shared).collect();
    let distinct =
        |part: fn(&(&'r str, &'r str)) -> &'r str| shared.iter().map(part).collect::<BTreeSet<_>>().len();
    let mut rows: Vec<MeanRow> = kept
        .iter()
        .filter_map(|(structure, of)| {
            let cells: Vec<&Cell> = shared.iter().map(|key| of[key]).collect();
            let ns: Option<Vec<f64>> = cells.iter().map(|cell| cell.ns()).collect();
            let bytes: Option<Vec<f64>> = cells.iter().map(|cell| bytes_per_object(record, cell)).collect();
            Some(MeanRow {
                structure,
                ns: geometric_mean(&ns?)?,
                bytes: bytes.and_then(|bytes| geometric_mean(&bytes)),
                cells,
            })
        })
        .collect();
    rows.sort_by(|a, b| a.ns.total_cmp(&b.ns));
    let left_out = few.into_iter().map(|(structure, of)| (structure, of.len())).collect();
    let (scenes, sets) = (distinct(|key| key.0), distinct(|key| key.1));
    (!rows.is_empty()).then_some(Overall { rays: name, scenes, sets, rows, left_out })
}

/// Bytes of structure and geometry copy for each object of the scene. A structure that holds
/// nothing counts as one byte, so that it has a place on a logarithmic scale.
pub fn bytes_per_object(record: &Record, cell: &Cell) -> Option<f64> {
    let bytes = cell.bytes.as_ref()?;
    let objects = record.scene(&cell.scene)?.objects.max(1);
    Some(bytes.structure.saturating_add(bytes.geometry_copy).max(1) as f64 / objects as f64)
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
        assert_eq!(parallel.scenes, 2);
        assert_eq!(parallel.rows[0].structure, "c");
        // 5 ns on one scene, 20 on the other: 10 in the geometric mean.
        assert!((parallel.rows[0].ns - 10.0).abs() < 0.01);
        // c failed on one of two scenes with random rays: too few to take part.
        let random = all.iter().find(|o| o.rays == "random").unwrap();
        assert_eq!(random.left_out, [("c", 1)]);
        assert_eq!(random.rows.iter().map(|row| row.structure).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(random.scenes, 2);
    }

    #[test]
    fn kinds_take_all_their_sets_together() {
        let mut record = testing::record();
        assert!(by_kind(&record, 1).is_empty(), "one set of each kind says it all");
        for mut cell in record.cells.clone().into_iter().filter(|cell| cell.rays == "random") {
            cell.rays = "diffuse".into();
            record.cells.push(cell);
        }
        let [lists] = &by_kind(&record, 1)[..] else { panic!("lists alone") };
        assert_eq!((lists.rays, lists.extent().as_str()), ("lists of rays", "2 scenes and 2 ray sets"));
        assert_eq!(lists.reference().unwrap().structure, "a");
        for cell in record.cells.iter_mut().filter(|cell| cell.structure == "b") {
            cell.structure = "embree".into();
        }
        assert_eq!(by_kind(&record, 1)[0].reference().unwrap().structure, "embree");
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
