//! Changes between made-up runs, with the noise that real runs have.

use super::*;
use crate::testing;

#[test]
fn a_planted_slowdown_is_flagged_and_the_same_record_is_not() {
    let a = testing::record();
    let mut b = a.clone();
    assert!(changes(&a, &b).iter().all(|change| change.ratio == 1.0 && !change.beyond_noise));
    let slow = &mut b.cells[1];
    slow.trace_ns.iter_mut().for_each(|ns| *ns = *ns * 115 / 100);
    slow.summarise();
    let changes = changes(&a, &b);
    assert_eq!(changes.len(), a.cells.len() - 1, "a failed cell has no change");
    let flagged: Vec<_> = changes.iter().filter(|c| c.beyond_noise).collect();
    assert_eq!(flagged.len(), 1);
    assert!(flagged[0].structure == "b" && (flagged[0].ratio - 1.15).abs() < 0.01);
}

/// Uniform numbers in (0, 1).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// About normal: mean 0, deviation 1.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }

    /// Student's t with three degrees of freedom, scaled to the quartiles of the normal: heavy tails.
    fn heavy(&mut self) -> f64 {
        let chi: f64 = (0..3).map(|_| self.normal().powi(2)).sum();
        0.88 * self.normal() / (chi / 3.0).sqrt()
    }
}

const STRUCTURES: usize = 9;
const SETS: usize = 4;

/// A run of 36 cells: all are slower or faster together by a few per cent, each by some more, one sample in ten
/// is disturbed, and one structure takes `factor` times as long.
fn run(dice: &mut Dice, factor: f64) -> Record {
    let mut record = testing::record();
    record.cells.clear();
    let drift = (0.04 * dice.normal()).exp();
    for set in 0..SETS {
        for structure in 0..STRUCTURES {
            let planted = if structure == 3 { factor } else { 1.0 };
            let own = (0.01 * dice.heavy().clamp(-4.0, 4.0)).exp();
            let mut cell =
                testing::cell("one", &format!("set-{set}"), &format!("structure-{structure}"), 100.0);
            cell.trace_ns = (0..7)
                .map(|_| {
                    let disturbed = if dice.next() < 0.1 { 1.0 - 0.3 * dice.next().ln() } else { 1.0 };
                    (1e6 * drift * own * planted * disturbed * (0.01 * dice.normal()).exp()) as u64
                })
                .collect();
            cell.summarise();
            record.cells.push(cell);
        }
    }
    record
}

#[test]
fn runs_of_the_same_program_raise_no_alarm() {
    let mut dice = Dice(7);
    let mut alarms = 0;
    for _ in 0..100 {
        let (a, b) = (run(&mut dice, 1.0), run(&mut dice, 1.0));
        alarms += usize::from(changes(&a, &b).iter().any(|change| change.beyond_noise));
    }
    assert!(alarms <= 5, "{alarms} of 100 pairs");
}

#[test]
fn a_structure_that_is_slower_by_15_percent_is_found_and_no_other() {
    let mut dice = Dice(11);
    let (mut found, mut pairs_found, mut others) = (0, 0, 0);
    for _ in 0..50 {
        let (a, b) = (run(&mut dice, 1.0), run(&mut dice, 1.15));
        let changes = changes(&a, &b);
        let slower = |c: &&Change| c.beyond_noise && c.ratio > 1.0 && c.structure == "structure-3";
        let here = changes.iter().filter(slower).count();
        found += here;
        pairs_found += usize::from(here > 0);
        others += changes.iter().filter(|c| c.beyond_noise && c.structure != "structure-3").count();
    }
    assert!(pairs_found >= 48, "found in {pairs_found} of 50 pairs");
    assert!(found >= 50 * SETS * 6 / 10, "{found} of {} cells", 50 * SETS);
    assert!(others <= 2, "{others} others");
}

#[test]
fn what_all_cells_share_is_drift_and_no_change() {
    let mut dice = Dice(3);
    let (a, mut b) = (run(&mut dice, 1.0), run(&mut dice, 1.0));
    for cell in &mut b.cells {
        cell.trace_ns.iter_mut().for_each(|ns| *ns = *ns * 3 / 2);
        cell.summarise();
    }
    let changes = changes(&a, &b);
    assert!(changes.iter().all(|c| c.drift > 1.2));
    let flagged = changes.iter().filter(|c| c.beyond_noise).count();
    assert!(flagged <= 1, "{flagged} of {}", changes.len());
}

#[test]
fn a_structure_alone_is_compared_with_itself() {
    let one = |ns: f64| {
        let mut record = testing::record();
        record.cells = vec![testing::cell("one", "random", "a", ns)];
        record
    };
    let between = |ns: f64| changes(&one(100.0), &one(ns)).remove(0);
    assert!(between(130.0).beyond_noise && between(70.0).beyond_noise);
    assert!(!between(103.0).beyond_noise && between(103.0).drift == 1.0);
}
