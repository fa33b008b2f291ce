//! Changes between made-up runs, with the noise that real runs have.

use super::*;
use crate::testing;

fn slow(cell: &mut Cell, factor: f64) {
    cell.trace_ns.iter_mut().for_each(|ns| *ns = (*ns as f64 * factor) as u64);
    cell.summarise();
}

#[test]
fn a_planted_slowdown_is_flagged_and_the_same_record_is_not() {
    let a = testing::record();
    let mut b = a.clone();
    let same = changes(&a, &b);
    assert!(same.cells.iter().all(|change| change.judged.ratio == 1.0 && !change.judged.beyond_noise));
    assert!(same.structures.iter().all(|shift| shift.judged.ratio == 1.0 && !shift.judged.beyond_noise));
    slow(&mut b.cells[1], 1.15);
    let changes = changes(&a, &b);
    assert_eq!(changes.cells.len(), a.cells.len() - 1, "a failed cell has no change");
    let flagged: Vec<_> = changes.cells.iter().filter(|c| c.judged.beyond_noise).collect();
    assert_eq!(flagged.len(), 1);
    assert!(flagged[0].structure == "b" && (flagged[0].judged.ratio - 1.15).abs() < 0.01);
    assert!(changes.structures.iter().all(|s| !s.judged.beyond_noise), "one cell of four is no shift");
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
const PASSES: usize = 3;

/// How a machine disturbs.
#[derive(Clone, Copy)]
struct Noise {
    sets: usize,
    /// Share of the times, as long as it takes to sample a ray set, in which something else runs on the core.
    busy: f64,
}

const QUIET: Noise = Noise { sets: 4, busy: 0.0 };
const BUSY: Noise = Noise { sets: 8, busy: 0.2 };

/// A run: all cells are slower or faster together by a few per cent, each by some more, one sample in ten
/// is disturbed, other work slows a ray set in a pass by factors of each structure's own (up to two), and one structure takes
/// `factor` times as long.
fn run(dice: &mut Dice, noise: Noise, factor: f64) -> Record {
    let mut record = testing::record();
    record.cells.clear();
    let drift = (0.04 * dice.normal()).exp();
    for set in 0..noise.sets {
        let busy: Vec<bool> = (0..PASSES).map(|_| dice.next() < noise.busy).collect();
        for structure in 0..STRUCTURES {
            let planted = if structure == 3 { factor } else { 1.0 };
            let own = (0.01 * dice.heavy().clamp(-4.0, 4.0)).exp();
            let mut cell =
                testing::cell("one", &format!("set-{set}"), &format!("structure-{structure}"), 100.0);
            cell.passes = vec![3, 2, 2];
            cell.trace_ns.clear();
            for (samples, busy) in cell.passes.iter().zip(&busy) {
                let load = if *busy { 1.1 + structure as f64 * 0.1 } else { 1.0 };
                for _ in 0..*samples {
                    let disturbed = if dice.next() < 0.1 { 1.0 - 0.3 * dice.next().ln() } else { 1.0 };
                    let sample = drift * own * planted * disturbed * load * (0.01 * dice.normal()).exp();
                    cell.trace_ns.push((1e6 * sample) as u64);
                }
            }
            cell.summarise();
            record.cells.push(cell);
        }
    }
    record
}

fn alarms(changes: &Changes) -> usize {
    let of_cells = changes.cells.iter().filter(|c| c.judged.beyond_noise).count();
    of_cells + changes.structures.iter().filter(|s| s.judged.beyond_noise).count()
}

#[test]
fn runs_of_the_same_program_raise_no_alarm() {
    for (noise, seed) in [(QUIET, 7), (BUSY, 8)] {
        let mut dice = Dice(seed);
        let mut found = 0;
        for _ in 0..100 {
            let (a, b) = (run(&mut dice, noise, 1.0), run(&mut dice, noise, 1.0));
            found += usize::from(alarms(&changes(&a, &b)) > 0);
        }
        assert!(found <= 5, "{found} of 100 pairs with a busy share of {}", noise.busy);
    }
}

#[test]
fn a_structure_that_is_slower_by_15_percent_is_found_and_no_other() {
    for (noise, seed) in [(QUIET, 11), (BUSY, 12)] {
        let mut dice = Dice(seed);
        let (mut found, mut others) = (0, 0);
        for _ in 0..50 {
            let (a, b) = (run(&mut dice, noise, 1.0), run(&mut dice, noise, 1.15));
            let changes = changes(&a, &b);
            let slower =
                |s: &Shift| s.judged.beyond_noise && s.judged.ratio > 1.0 && s.structure == "structure-3";
            found += usize::from(changes.structures.iter().any(slower));
            let other = |id: &str, judged: &Judged| usize::from(judged.beyond_noise && id != "structure-3");
            others += changes.structures.iter().map(|s| other(&s.structure, &s.judged)).sum::<usize>();
            others += changes.cells.iter().map(|c| other(&c.structure, &c.judged)).sum::<usize>();
        }
        assert!(found >= 48, "found in {found} of 50 pairs with a busy share of {}", noise.busy);
        assert!(others <= 2, "{others} others with a busy share of {}", noise.busy);
    }
}

/// Had the passes not been told apart, a disturbed cell would look well known.
#[test]
fn passes_that_disagree_widen_the_range_of_their_cell() {
    let mut a = testing::record();
    let mut b = a.clone();
    let cell = &mut b.cells[1];
    cell.trace_ns = [150, 150, 150, 120, 120, 120].map(|n| n * 200).into();
    cell.passes = vec![3, 3];
    cell.summarise();
    let change = |a: &Record, b: &Record| changes(a, b).cells.remove(1).judged;
    assert!((change(&a, &b).relative() - 1.2).abs() < 0.05 && !change(&a, &b).beyond_noise);
    b.cells[1].trace_ns = [121, 150, 150, 120, 120, 120].map(|n| n * 200).into();
    assert!(change(&a, &b).beyond_noise, "both passes reached it");
    std::mem::swap(&mut a, &mut b);
    assert!(change(&a, &b).beyond_noise && change(&a, &b).relative() < 0.9);
}

/// Embree's packets on a small scene: in one pass of five the build happens to lie so that they take a twelfth less.
#[test]
fn a_lucky_build_in_one_pass_is_no_change() {
    let mut dice = Dice(5);
    let (mut a, mut b) = (run(&mut dice, QUIET, 1.0), run(&mut dice, QUIET, 1.0));
    for cell in a.cells.iter_mut().chain(&mut b.cells) {
        cell.passes = vec![2, 2, 1, 1, 1];
    }
    let lucky = |cell: &mut Cell| {
        cell.trace_ns[5] = cell.trace_ns[5] * 11 / 12;
        cell.summarise();
    };
    b.cells.iter_mut().filter(|cell| cell.structure == "structure-3").for_each(lucky);
    let changes = changes(&a, &b);
    let shift = changes.structures.iter().find(|s| s.structure == "structure-3").expect("in both");
    assert!(!shift.judged.beyond_noise && shift.judged.relative() > 0.96, "{shift:?}");
}

#[test]
fn what_all_cells_share_is_drift_and_no_change() {
    let mut dice = Dice(3);
    let (a, mut b) = (run(&mut dice, QUIET, 1.0), run(&mut dice, QUIET, 1.0));
    b.cells.iter_mut().for_each(|cell| slow(cell, 1.5));
    let changes = changes(&a, &b);
    assert!(changes.cells.iter().all(|c| c.judged.drift > 1.2));
    assert!(changes.structures.iter().all(|s| s.judged.drift > 1.2));
    assert!(alarms(&changes) <= 1, "{} of {}", alarms(&changes), changes.cells.len());
}

#[test]
fn a_structure_alone_is_compared_with_itself() {
    let one = |ns: f64| {
        let mut record = testing::record();
        record.cells = vec![testing::cell("one", "random", "a", ns)];
        record
    };
    let between = |ns: f64| changes(&one(100.0), &one(ns)).cells.remove(0).judged;
    assert!(between(130.0).beyond_noise && between(70.0).beyond_noise);
    assert!(!between(103.0).beyond_noise && between(103.0).drift == 1.0);
}

#[test]
fn cells_without_a_least_time_are_left_out() {
    let mut a = testing::record();
    let b = a.clone();
    a.cells[0].trace_ns.fill(0);
    a.cells[0].summarise();
    a.cells[1].trace_ns.clear();
    a.cells[1].summarise();
    assert_eq!(changes(&a, &b).cells.len(), a.cells.len() - 3);
    assert_eq!(changes(&a, &testing::record()).structures.len(), 3);
}
