//! Reports of a known record.

use super::*;
use harness::grouped::Measure;
use harness::record::Outcome;
use harness::testing;

#[test]
fn tables_have_a_place_for_everything() {
    let text = cells::figures(&testing::record().cells, Measure::Trace).text();
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(lines[0], ["scene,", "rays", "a", "b", "c"]);
    assert_eq!(lines[1], ["one", "parallel", "10.0", "20.0", "5.00"]);
    assert_eq!(lines[2], ["one", "random", "20.0", "40.0", "failed"]);
    assert_eq!(lines.len(), 5);
    let ends: Vec<_> = text.lines().take(2).map(|line| line.chars().count()).collect();
    assert_eq!(ends[0], ends[1], "columns end together:\n{text}");
}

#[test]
fn the_report_says_what_was_run_and_what_failed() {
    let report = markdown(&testing::record());
    for part in [
        "`rayscale measure`",
        "FTZ off",
        "Rasters: geometric means of ratios to `a` over the 2 cells",
        "Lists of rays: geometric means of ratios to `a` over the 1 cells that all share (1 left out)",
        "| c | 0.500 |",
        "| one | 1,000 | triangles |",
        "`embree` was left out: not here",
        "`c` on one random: it fell over",
        "ν_mem",
    ] {
        assert!(report.contains(part), "no `{part}` in:\n{report}");
    }
}

#[test]
fn csv_has_a_row_for_every_cell() {
    let record = testing::record();
    let mut out = Vec::new();
    cells::all(&record).csv(&mut out).unwrap();
    let mut rows = ::csv::Reader::from_reader(out.as_slice());
    let head = rows.headers().unwrap().clone();
    let place = |name: &str| head.iter().position(|h| h == name).unwrap();
    let rows: Vec<_> = rows.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), record.cells.len());
    assert_eq!(&rows[5][place("error")], "it fell over");
    assert_eq!(rows[0][place("ns_per_ray_median")].parse::<f64>().unwrap(), 10.0);
    assert_eq!(&rows[0][place("missed")], "", "not judged is not zero");
}

#[test]
fn only_what_lies_between_the_markers_changes() {
    let text = format!("before\n{BEGIN}\nold\n{END}\nafter\n");
    let new = splice(&text, "new").unwrap();
    assert_eq!(new, format!("before\n{BEGIN}\nnew\n{END}\nafter\n"));
    assert_eq!(splice(&new, "new").unwrap(), new);
    for bad in [format!("{END}\n{BEGIN}"), BEGIN.to_owned(), String::new(), format!("{text}{text}")] {
        assert_eq!(splice(&bad, "new"), Err(SpliceError::Markers(BEGIN, END)));
    }
    let summary = summary(&testing::record(), "rayscale report record.json --splice README.md");
    assert!(summary.contains("--splice README.md") && summary.contains("| c | 0.500 |"));
}

#[test]
fn names_from_outside_stay_text() {
    let mut record = testing::record();
    let evil = format!("<b>|x|</b>\n# head\n{END}");
    for cell in &mut record.cells {
        cell.scene.push_str(&evil);
        cell.structure.push_str(&evil);
        cell.outcome = Outcome::Failed(evil.clone());
    }
    for scene in &mut record.scenes {
        scene.id.push_str(&evil);
        scene.source = evil.clone();
    }
    record.machine.cpu = evil.clone();
    record.command = "rayscale `measure`".into();
    record.skipped[0].reason = evil;
    let report = markdown(&record);
    assert!(!report.contains("<b>") && !report.contains("\n# head"), "{report}");
    for row in report.lines().filter(|line| line.starts_with('|')) {
        assert!(row.ends_with('|') && !row.contains("|x|"), "{row}");
    }
    let summary = summary(&record, "rayscale report");
    assert!(!summary.contains("<b>") && splice(&format!("{BEGIN}\n{END}"), &summary).is_ok(), "{summary}");
}

#[test]
fn nothing_with_a_marker_is_spliced() {
    let text = format!("{BEGIN}\n{END}");
    for marker in [BEGIN, END] {
        assert_eq!(splice(&text, &format!("made by `{marker}`")), Err(SpliceError::Inside(BEGIN, END)));
    }
}
