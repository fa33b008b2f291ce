//! What a record says, in plain words.

use super::aggregate::{Overall, bytes_per_object};
use super::scale::trimmed;
use super::svg::escape;
use harness::record::{Cell, Intersector, Record};
use harness::stats::median;
use harness::units;

/// The structure that reports look at most closely.
const OURS: &str = "bmssm";

/// Differences below this share are called level.
const LEVEL: f64 = 1.03;

/// The summary as HTML list items.
pub fn summary(record: &Record, overall: &[Overall], threads: usize) -> String {
    let mut items: Vec<String> = overall.iter().map(who_wins).collect();
    items.extend(ours(record, overall, threads));
    items.extend(least_memory(record, threads));
    items.push(checks(record));
    items.extend(left_out(record));
    items.iter().map(|item| format!("<li>{item}</li>\n")).collect()
}

fn strong(name: &str) -> String {
    format!("<strong>{}</strong>", escape(name))
}

fn times(ratio: f64) -> String {
    format!("{}×", trimmed(ratio))
}

fn scenes(n: usize) -> String {
    if n == 1 { "1 scene".to_owned() } else { format!("{n} scenes") }
}

/// Who is fastest on a ray set, by how much, and where `bmssm` stands.
fn who_wins(overall: &Overall) -> String {
    let rows = &overall.rows;
    let first = &rows[0];
    let rays = escape(overall.rays);
    let mut text = format!(
        "On <em>{rays}</em> rays {} is fastest: {} per ray",
        strong(first.structure),
        units::time(first.ns)
    );
    if let Some(second) = rows.get(1) {
        let ratio = second.ns / first.ns;
        text += &if ratio < LEVEL {
            format!(", level with {}", strong(second.structure))
        } else {
            format!("; {} takes {} as long", strong(second.structure), times(ratio))
        };
    }
    if let Some((place, row)) = rows.iter().enumerate().skip(2).find(|(_, row)| row.structure == OURS) {
        text += &format!(
            ", {} {} (place {} of {})",
            strong(OURS),
            times(row.ns / first.ns),
            place + 1,
            rows.len()
        );
    }
    text + &format!(" (geometric mean over {}).", scenes(overall.scenes.len()))
}

/// How `bmssm` compares with the best other structure on every scene and ray set.
fn ours(record: &Record, overall: &[Overall], threads: usize) -> Vec<String> {
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
        return if here { Vec::new() } else { vec![format!("{} was not measured.", strong(OURS))] };
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (won, lost): (Vec<_>, Vec<_>) = ratios.iter().partition(|(ratio, ..)| *ratio < 1.0);
    let place = |(ratio, cell, other): &&(f64, &Cell, &Cell)| {
        format!(
            "{}/{} ({} the time of {})",
            escape(&cell.scene),
            escape(&cell.rays),
            times(*ratio),
            escape(&other.structure)
        )
    };
    let list = |all: Vec<String>| all.join(", ");
    let all = ratios.len();
    let mut items = Vec::new();
    if won.is_empty() {
        items.push(format!(
            "{} is the fastest structure nowhere among {all} pairs of scene and rays.",
            strong(OURS)
        ));
    } else {
        let best = list(won.iter().copied().take(3).map(|r| place(&r)).collect());
        items.push(format!(
            "{} is the fastest on {} of {all} pairs of scene and rays; best: {best}.",
            strong(OURS),
            won.len()
        ));
    }
    if lost.is_empty() {
        items.push(format!("{} loses nowhere.", strong(OURS)));
    } else {
        let worst = list(lost.iter().rev().copied().take(3).map(|r| place(&r)).collect());
        items.push(format!(
            "{} loses to the best other structure on {} of {all}; worst: {worst}.",
            strong(OURS),
            lost.len()
        ));
    }
    items
}

/// Bytes per object of every structure, the least first.
fn least_memory(record: &Record, threads: usize) -> Option<String> {
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
    let words: Vec<String> =
        medians.iter().map(|(bytes, name)| format!("{} {} B", strong(name), trimmed(*bytes))).collect();
    (!words.is_empty()).then(|| {
        format!(
            "Memory per object, copies of the geometry included (median over all cells): {}.",
            words.join(", ")
        )
    })
}

/// Whether the answers were right.
fn checks(record: &Record) -> String {
    let (own, foreign): (Vec<&Cell>, Vec<&Cell>) = record
        .cells
        .iter()
        .filter(|cell| cell.check.is_some())
        .partition(|cell| cell.kernel != Intersector::External);
    let rays =
        |cells: &[&Cell]| cells.iter().filter_map(|c| c.check.as_ref()).map(|c| c.rays_checked).sum::<u64>();
    let differences =
        |cells: &[&Cell]| cells.iter().filter_map(|c| c.check.as_ref()).map(|c| c.differences).sum::<u64>();
    if own.is_empty() && foreign.is_empty() {
        return "No answer was checked against brute force.".to_owned();
    }
    let mut text = String::from("Answers checked against brute force: ");
    if !own.is_empty() {
        let (rays, differences) = (units::count(rays(&own)), differences(&own));
        text += &match differences {
            0 => format!("structures with the same ray-triangle test give the same bits on all {rays} rays"),
            n => format!(
                "<strong class=\"bad\">structures with the same ray-triangle test differ on {} of {rays} rays</strong>",
                units::count(n)
            ),
        };
    }
    if !foreign.is_empty() {
        let join = if own.is_empty() { "" } else { "; " };
        text += &format!(
            "{join}structures with a test of their own give other bits on {} of {} (what is \
             wrong by exact arithmetic is under <a href=\"#errors\">errors</a>)",
            units::count(differences(&foreign)),
            units::count(rays(&foreign))
        );
    }
    text + "."
}

/// What failed or was skipped.
fn left_out(record: &Record) -> Option<String> {
    let failed = record.cells.iter().filter(|cell| !cell.outcome.is_measured()).count();
    let skipped: Vec<String> =
        record.skipped.iter().map(|s| format!("{} ({})", escape(&s.id), escape(&s.reason))).collect();
    if failed == 0 && skipped.is_empty() {
        return None;
    }
    let mut parts = Vec::new();
    if failed > 0 {
        parts.push(format!("{failed} of {} cells have no figure; the table says why", record.cells.len()));
    }
    if !skipped.is_empty() {
        parts.push(format!("skipped: {}", skipped.join(", ")));
    }
    Some(format!("Left out: {}.", parts.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::super::aggregate::overall;
    use super::*;
    use harness::testing;

    fn of(record: &Record) -> String {
        summary(record, &overall(record, 1), 1)
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
