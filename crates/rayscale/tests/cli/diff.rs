//! `rayscale diff` as a guard against slowdowns.

use crate::common::{Folder, rayscale};
use crate::records::large;
use harness::record::{Record, write};
use predicates::str::contains;

fn diff(folder: &Folder, after: &Record, more: &[&str]) -> assert_cmd::assert::Assert {
    write(&folder.path("before.json"), &large()).expect("a record");
    write(&folder.path("after.json"), after).expect("a record");
    let mut command = rayscale(["diff", "before.json", "after.json"]);
    command.args(more).current_dir(folder.folder()).assert()
}

/// The large record with one structure slower by a share; its noisiest sample stays in place.
fn slower(structure: &str, share: f64) -> Record {
    let mut record = large();
    for cell in record.cells.iter_mut().filter(|cell| cell.structure == structure) {
        cell.trace_ns.iter_mut().for_each(|ns| *ns = (*ns as f64 * (1.0 + share)) as u64);
        cell.summarise();
    }
    record
}

#[test]
fn a_slowdown_beyond_the_limit_fails() {
    let folder = Folder::new();
    diff(&folder, &slower("embree", 0.5), &["--fail-above", "10%"]).code(1).stdout(contains("embree"));
    diff(&folder, &slower("embree", 0.5), &["--fail-above", "60%"]).code(0);
    diff(&folder, &slower("embree", 0.5), &[]).code(0);
}

#[test]
fn the_same_record_and_a_faster_one_pass() {
    let folder = Folder::new();
    diff(&folder, &large(), &["--fail-above", "0%"]).code(0);
    diff(&folder, &slower("embree", -0.3), &["--fail-above", "0%"]).code(0);
    diff(&folder, &large(), &["--fail-above", "much"]).code(2);
}
