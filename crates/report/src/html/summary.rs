//! What a record says, in plain words.

use crate::aggregate::{Overall, bytes_per_object};
use harness::record::{Cell, Check, Intersector, Record};
use harness::stats::median;
use harness::units::{self, figure, times};
use maud::{Markup, html};

/// The structure that reports look at most closely.
const OURS: &str = "bmssm";

/// Differences below this share are called level.
const LEVEL: f64 = 1.03;

/// The summary as a list.
pub fn summary(record: &Record, overall: &[Overall], threads: usize) -> Markup {
    let mut items: Vec<Markup> = overall.iter().map(who_wins).collect();
    items.extend(ours(record, overall, threads));
    items.extend(min_memory(record, threads));
    items.push(checks(record));
    items.extend(left_out(record));
    html! { ul.summary { @for item in &items { li { (item) } "\n" } } }
}

/// Items with commas between them.
fn list(items: &[Markup]) -> Markup {
    html! { @for (i, item) in items.iter().enumerate() { @if i > 0 { ", " } (item) } }
}

/// Who is fastest on a ray set, by how much, and where `bmssm` stands.
fn who_wins(overall: &Overall) -> Markup {
    let rows = &overall.rows;
    let first = &rows[0];
    let ours = rows.iter().enumerate().skip(2).find(|(_, row)| row.structure == OURS);
    html! {
        "On " em { (overall.rays) } " rays " strong { (first.structure) } " is fastest: " (units::time(first.ns)) " per ray"
        @if let Some(second) = rows.get(1) {
            @if second.ns / first.ns < LEVEL {
                ", level with " strong { (second.structure) }
            } @else {
                "; " strong { (second.structure) } " takes " (times(second.ns / first.ns)) " as long"
            }
        }
        @if let Some((place, row)) = ours {
            ", " strong { (OURS) } " " (times(row.ns / first.ns)) " (place " (place + 1) " of " (rows.len()) ")"
        }
        " (geometric mean over " (overall.extent()) ")."
    }
}

/// How `bmssm` compares with the best other structure on every scene and ray set.
fn ours(record: &Record, overall: &[Overall], threads: usize) -> Vec<Markup> {
    let mut ratios: Vec<(f64, &Cell, &Cell)> = Vec::new();
    for cell in record.cells.iter().filter(|c| c.structure == OURS && c.threads == threads) {
        let Some(ns) = cell.ns() else { continue };
        let same_work = |c: &&Cell| c.key() == cell.key() && c.structure_id() != OURS;
        let others = record.cells.iter().filter(same_work).filter_map(|c| Some((c.ns()?, c)));
        if let Some((best, other)) = others.min_by(|a, b| a.0.total_cmp(&b.0)) {
            ratios.push((ns / best, cell, other));
        }
    }
    if ratios.is_empty() {
        let here = overall.iter().any(|o| o.rows.iter().any(|row| row.structure == OURS));
        return if here { Vec::new() } else { vec![html! { strong { (OURS) } " was not measured." }] };
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (won, lost): (Vec<_>, Vec<_>) = ratios.iter().partition(|(ratio, ..)| *ratio < 1.0);
    let place = |(ratio, cell, other): &(f64, &Cell, &Cell)| {
        html! { (cell.scene) "/" (cell.rays) " (" (times(*ratio)) " the time of " (other.structure) ")" }
    };
    let all = ratios.len();
    let best: Vec<Markup> = won.iter().take(3).map(place).collect();
    let worst: Vec<Markup> = lost.iter().rev().take(3).map(place).collect();
    vec![
        html! {
            strong { (OURS) }
            @if won.is_empty() {
                " is the fastest structure nowhere among " (all) " pairs of scene and rays."
            } @else {
                " is the fastest on " (won.len()) " of " (all) " pairs of scene and rays; best: " (list(&best)) "."
            }
        },
        html! {
            strong { (OURS) }
            @if lost.is_empty() {
                " loses nowhere."
            } @else {
                " loses to the best other structure on " (lost.len()) " of " (all) "; worst: " (list(&worst)) "."
            }
        },
    ]
}

/// Bytes per object of every structure, the least first.
fn min_memory(record: &Record, threads: usize) -> Option<Markup> {
    let mut medians: Vec<(f64, &str)> = record
        .structure_ids()
        .into_iter()
        .filter_map(|structure| {
            let cells = record.cells.iter().filter(|c| c.structure == structure && c.threads == threads);
            let bytes: Vec<f64> = cells.filter_map(|cell| bytes_per_object(record, cell)).collect();
            Some((median(&bytes)?, structure))
        })
        .collect();
    medians.sort_by(|a, b| a.0.total_cmp(&b.0));
    let of = |(bytes, name): &(f64, &str)| html! { strong { (name) } " " (figure(*bytes)) " B" };
    let words: Vec<Markup> = medians.iter().map(of).collect();
    (!words.is_empty()).then(|| {
        html! {
            "Memory per object, copies of the geometry included (median over all cells): " (list(&words)) "."
        }
    })
}

/// Whether the answers were right.
fn checks(record: &Record) -> Markup {
    let (own, external): (Vec<&Cell>, Vec<&Cell>) = record
        .cells
        .iter()
        .filter(|cell| cell.check.is_some())
        .partition(|cell| cell.kernel != Intersector::External);
    let sum = |cells: &[&Cell], of: fn(&Check) -> u64| {
        let all = cells.iter().filter_map(|cell| cell.check.as_ref());
        all.map(of).fold(0, u64::saturating_add)
    };
    let rays = |cells: &[&Cell]| units::count(sum(cells, |check| check.rays_checked));
    let differences = |cells: &[&Cell]| sum(cells, |check| check.differences);
    if own.is_empty() && external.is_empty() {
        return html! { "No answer was checked against brute force." };
    }
    html! {
        "Answers checked against brute force: "
        @if !own.is_empty() {
            @match differences(&own) {
                0 => { "structures with the same ray-triangle test give the same bits on all " (rays(&own)) " rays" }
                n => strong.bad {
                    "structures with the same ray-triangle test differ on " (units::count(n)) " of " (rays(&own)) " rays"
                }
            }
        }
        @if !external.is_empty() {
            @if !own.is_empty() { "; " }
            "structures with a test of their own give other bits on " (units::count(differences(&external))) " of "
            (rays(&external)) " (what is wrong by exact arithmetic is under " a href="#errors" { "errors" } ")"
        }
        "."
    }
}

/// What failed or was skipped.
fn left_out(record: &Record) -> Option<Markup> {
    let failed = record.cells.iter().filter(|cell| !cell.outcome.is_measured()).count();
    let skipped: Vec<Markup> = record.skipped.iter().map(|s| html! { (s.id) " (" (s.reason) ")" }).collect();
    (failed > 0 || !skipped.is_empty()).then(|| {
        html! {
            "Left out: "
            @if failed > 0 { (failed) " of " (record.cells.len()) " cells have no figure; the table says why" }
            @if failed > 0 && !skipped.is_empty() { "; " }
            @if !skipped.is_empty() { "skipped: " (list(&skipped)) }
            "."
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aggregate::overall;
    use harness::testing;

    fn of(record: &Record) -> String {
        summary(record, &overall(record, 1), 1).into_string()
    }

    #[test]
    fn winners_and_gaps_are_named() {
        let text = of(&testing::record());
        assert!(text.contains("On <em>parallel</em> rays <strong>c</strong> is fastest: 10.0 ns per ray; <strong>a</strong> takes 2× as long"), "{text}");
        assert!(text.contains("On <em>random</em> rays <strong>a</strong> is fastest"), "{text}");
        assert!(text.contains("<strong>bmssm</strong> was not measured"), "{text}");
        assert!(
            text.contains("embree (not here)") && text.contains("1 of 12 cells have no figure"),
            "{text}"
        );
    }

    #[test]
    fn losses_are_told_as_plainly_as_wins() {
        let mut record = testing::record();
        for cell in record.cells.iter_mut().filter(|cell| cell.structure == "b") {
            cell.structure = OURS.into();
        }
        let text = of(&record);
        assert!(
            text.contains("<strong>bmssm</strong> is the fastest structure nowhere among 4 pairs"),
            "{text}"
        );
        assert!(text.contains("loses to the best other structure on 4 of 4; worst: "), "{text}");
        assert!(text.contains("(4× the time of c)"), "{text}");
        for cell in record.cells.iter_mut().filter(|cell| cell.structure == OURS) {
            cell.trace_ns.iter_mut().for_each(|ns| *ns /= 100);
            cell.summarise();
        }
        assert!(of(&record).contains("fastest on 4 of 4"), "{}", of(&record));
        assert!(of(&record).contains("loses nowhere"));
    }

    #[test]
    fn a_wrong_answer_is_not_hidden() {
        let mut record = testing::record();
        assert!(of(&record).contains("give the same bits"));
        record.cells[0].check.as_mut().unwrap().differences = 3;
        assert!(of(&record).contains("class=\"bad\">structures with the same ray-triangle test differ on 3"));
    }
}
