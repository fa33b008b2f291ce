//! Records that earlier versions wrote are still read.

use crate::common::{Folder, rayscale};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use std::path::PathBuf;

/// The record of the default comparison that the repository keeps.
fn kept() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../reports/2026-11-22/record.json")
}

#[test]
fn the_kept_record_is_ranked_compared_and_reported() {
    let (folder, record) = (Folder::new(), kept());
    let run = |verb: &str, more: &[&str]| {
        let mut command = rayscale([verb]);
        command.arg(&record).args(more).current_dir(folder.folder()).assert().success()
    };
    run("cmp", &[]).stdout(contains("sponza perspective"));
    run("rank", &["--to", "embree", "--rays", "parallel"]).stdout(contains("bmssm"));
    run("diff", &[record.to_str().expect("a path in UTF-8"), "--all"])
        .stdout(contains("0 of ").and(contains("1.000")));
    run("report", &["--out", "made"]);
    assert!(folder.read("made/report.md").contains("| bmssm | "));
    assert!(folder.read("made/cells.csv").lines().count() > 100);
    let page = folder.read("made/report.html");
    for part in ["lists of rays", "time per ray / embree", "<section id=\"errors\">", "</html>"] {
        assert!(page.contains(part), "no {part}");
    }
}
