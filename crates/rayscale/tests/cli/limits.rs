//! Limits of memory, and work that takes long and is asked to end.
#![cfg(target_os = "linux")]

use crate::common::Folder;
use harness::record::read;
use predicates::prelude::*;
use predicates::str::contains;
use rustix::process::{Pid, Signal, kill_process};
use std::fmt::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Triangles across the whole scene: grids list them in most cells.
fn large_triangles() -> String {
    let mut state = 1u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let mut text = String::new();
    for i in 0..1000 {
        for _ in 0..3 {
            let _ = writeln!(text, "v {} {} {}", number(), number(), number());
        }
        let _ = writeln!(text, "f {} {} {}", 3 * i + 1, 3 * i + 2, 3 * i + 3);
    }
    text
}

fn measure(folder: &Folder, more: &[&str]) -> Command {
    folder.write("large.obj", large_triangles());
    let mut command = Command::new(env!("CARGO_BIN_EXE_rayscale"));
    command.current_dir(folder.folder()).args(["measure", "--scene", "large.obj", "--rays", "random"]);
    command
        .args(["--size", "8", "--rounds", "1", "--structure", "ssm-list", "--out", "record.json"])
        .args(more);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Long beside what a machine under load takes, short beside what the work would.
const PATIENCE: Duration = Duration::from_secs(100);

#[test]
fn memory_by_resolution_ends_when_it_is_asked_to() {
    for signal in [Signal::INT, Signal::TERM] {
        let folder = Folder::new();
        let mut child = measure(&folder, &[]).spawn().expect("a process");
        let start = Instant::now();
        // The cell is written before memory by resolution is begun.
        while !folder.path("record.json").exists() && child.try_wait().expect("a process").is_none() {
            assert!(start.elapsed() < PATIENCE, "no record came");
            std::thread::sleep(Duration::from_millis(5));
        }
        // It may have ended by itself.
        let _ = kill_process(Pid::from_child(&child), signal);
        let output = child.wait_with_output().expect("a process");
        assert!(start.elapsed() < PATIENCE, "it did not end");
        let record = read(&folder.path("record.json")).expect("a whole record");
        assert_eq!(record.cells.len(), 1);
        let code = output.status.code();
        assert!(code == Some(130) && record.memory.is_empty() || code == Some(0), "{output:?}");
    }
}

#[test]
fn memory_by_resolution_keeps_to_the_time() {
    let folder = Folder::new();
    let output = measure(&folder, &["--time-budget", "1s"]).output().expect("a process");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let record = read(&folder.path("record.json")).expect("a record");
    let named = record.skipped.iter().any(|skipped| skipped.reason.contains("time was up"));
    assert!(record.memory.len() == 5 || named, "{:?}", record.skipped);
}

/// The program in a shell that gives it so many KiB of address space.
fn within(folder: &Folder, kib: u64, words: &str) -> assert_cmd::assert::Assert {
    let mut command = assert_cmd::Command::new("sh");
    command.env("RAYSCALE", env!("CARGO_BIN_EXE_rayscale")).current_dir(folder.folder());
    command.args(["-c", &format!("ulimit -v {kib}; exec \"$RAYSCALE\" {words}")]).assert()
}

#[test]
fn rays_that_memory_does_not_hold_are_left_out() {
    let folder = Folder::new();
    within(
        &folder,
        1 << 20,
        "measure --scene unit-one --rays random,perspective --size 8192 --structure ssm --no-memory --out record.json",
    )
    .code(0)
    .stderr(contains("panicked").not());
    let record = read(&folder.path("record.json")).expect("a record");
    let left_out = record.skipped.iter().filter(|skipped| skipped.reason.contains("--size")).count();
    assert_eq!((record.cells.len(), left_out), (0, 2), "{:?}", record.skipped);
}

#[test]
fn scenes_and_structures_that_memory_does_not_hold_are_errors() {
    let folder = Folder::new();
    let many = "id = 'many'\ndescription = 'x'\ncharacter = 'x'\n[generator]\nkind = 'triangles'\nobjects = 60000000\nedge = 1.0\n";
    folder.write("many.toml", many);
    within(&folder, 1 << 20, "render many.toml --size 8 --out out.png").code(2).stderr(contains("bytes"));
    within(&folder, 1 << 20, "render unit-one --size 8 --structure ssm:resolution=700 --out out.png")
        .code(2)
        .stderr(contains("bytes, more than the limit"));
    assert!(!folder.path("out.png").exists());
}

#[test]
fn a_disk_that_fills_up_leaves_whole_records() {
    let folder = Folder::new();
    let measure = |limit: &str| {
        let words = "measure --scene unit-one --rays random,axis,parallel --size 8 --rounds 2 --passes 2 --structure ssm \
                     --structure bmssm --no-memory --out record.json --resume";
        let mut command = assert_cmd::Command::new("sh");
        command.env("RAYSCALE", env!("CARGO_BIN_EXE_rayscale")).current_dir(folder.folder());
        // The signal that says so is turned into an error.
        command.args(["-c", &format!("trap '' XFSZ; ulimit -f {limit}; exec \"$RAYSCALE\" {words}")]).assert()
    };
    let mut before = 0;
    // In blocks of 512 bytes: a record of this run has some twenty of them.
    for blocks in [0, 4, 7, 10, 13, 16] {
        measure(&blocks.to_string()).code(predicate::in_iter([0, 2])).stderr(contains("panicked").not());
        let cells = match folder.path("record.json").exists() {
            true => read(&folder.path("record.json")).expect("a whole record").cells.len(),
            false => 0,
        };
        assert!(cells >= before, "what was there stays");
        before = cells;
        let left = std::fs::read_dir(folder.folder()).expect("a folder").count();
        assert!(left <= 1, "nothing else is left over");
    }
    measure("unlimited").code(0);
    let record = read(&folder.path("record.json")).expect("a record");
    assert!(record.cells.len() == 6 && record.run.is_some_and(|run| run.complete));
}
