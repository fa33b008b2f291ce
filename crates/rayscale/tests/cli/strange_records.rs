//! Records that somebody else wrote: whatever they hold, the program answers, and nothing in them acts on the reader's terminal,
//! spreadsheet or text.

use crate::common::{Folder, rayscale};
use crate::records::large;
use harness::record::{Record, write};
use std::time::Duration;

/// Runs a verb on the record and itself; what it said, on both streams.
fn run(record: &Record, arguments: &[&str]) -> String {
    let folder = Folder::new();
    write(&folder.path("record.json"), record).expect("a record");
    let mut command = rayscale(arguments);
    let done = command.current_dir(folder.folder()).timeout(Duration::from_secs(60)).assert().success();
    let output = done.get_output();
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes)).concat()
}

/// The record with every name changed.
fn renamed(change: impl Fn(&str) -> String) -> Record {
    let mut record = large();
    for cell in &mut record.cells {
        (cell.scene, cell.structure) = (change(&cell.scene), change(&cell.structure));
    }
    record
}

const VERBS: [&[&str]; 3] = [
    &["cmp", "record.json"],
    &["diff", "record.json", "record.json", "--all"],
    &["cmp", "record.json", "--json"],
];

#[test]
fn names_do_not_command_the_terminal() {
    let record = renamed(|name| format!("{name}\u{1b}]0;x\u{7}\u{9b}31m"));
    for verb in VERBS {
        let said = run(&record, verb);
        assert!(!said.contains(['\u{1b}', '\u{7}', '\u{9b}']), "{verb:?}");
        assert!(said.contains("\\u001b]0;x\\u0007\\u009b31m"), "{verb:?}");
    }
}

#[test]
fn names_may_be_very_long() {
    let record = renamed(|name| format!("{name}{}", "x".repeat(70_000)));
    for verb in VERBS {
        assert!(run(&record, verb).contains("embree"), "{verb:?}");
    }
    let to = &record.cells[0].structure;
    assert!(run(&record, &["rank", "record.json", "--rays", "diffuse", "--to", to]).contains("minmax"));
}

#[test]
fn passes_may_be_any_numbers() {
    let mut record = large();
    record.cells.iter_mut().for_each(|cell| cell.passes = vec![usize::MAX, 6]);
    assert!(run(&record, VERBS[1]).contains("0 of "));
}

#[test]
fn a_report_of_the_least_and_the_greatest_times_ends() {
    let mut record = large();
    for (cell, ns) in record.cells.iter_mut().zip([5e-324, 1e308].into_iter().cycle()) {
        if let Some(timing) = &mut cell.ns_per_ray {
            timing.median = ns;
        }
    }
    assert!(run(&record, &["report", "record.json", "--out", "made"]).contains("report.html"));
}
