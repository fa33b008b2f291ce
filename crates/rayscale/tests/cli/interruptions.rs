//! A measurement that is killed or stopped at any moment leaves a sound record, and goes on from there.
#![cfg(unix)]

use crate::common::Folder;
use crate::schema::of_record;
use harness::record::{Record, read};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const SCENES: [&str; 2] = ["unit-one", "small-10k"];
const RAYS: [&str; 3] = ["parallel", "random", "axis"];
const STRUCTURES: [&str; 3] = ["ssm", "bmssm", "bmssm:kernel=watertight"];

fn measure(folder: &Folder, rounds: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rayscale"));
    command.current_dir(folder.folder()).args(["measure", "--rays", &RAYS.join(","), "--size", "48"]);
    for scene in SCENES {
        command.args(["--scene", scene]);
    }
    for id in STRUCTURES {
        command.args(["--structure", id]);
    }
    command.args(["--rounds", rounds, "--no-memory", "--out", "record.json"]).args(more);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The cells of a record; panics unless the record is sound.
fn cells(path: &Path) -> Vec<Value> {
    let Ok(text) = std::fs::read_to_string(path) else { return Vec::new() };
    let value: Value = serde_json::from_str(&text).expect("a whole record");
    assert_eq!(of_record(&value), [""; 0]);
    read(path).expect("a record");
    value["cells"].as_array().expect("cells").clone()
}

/// Whether all cells are still there, in order, with at least the samples that they had.
fn goes_on(before: &[Value], now: &[Value]) -> bool {
    let name = |cell: &Value| ["scene", "rays", "structure"].map(|part| cell[part].clone());
    let list = |cell: &Value, part: &str| cell[part].as_array().expect("a list").clone();
    let kept = |(old, new): (&Value, &Value)| {
        name(old) == name(new)
            && ["trace_ns", "passes"].iter().all(|part| list(new, part).starts_with(&list(old, part)))
    };
    before.len() <= now.len() && before.iter().zip(now).all(kept)
}

/// Waits until the record has so many cells, or the process ends.
fn wait_for(child: &mut Child, path: &Path, least: usize) {
    let start = Instant::now();
    while child.try_wait().expect("a process").is_none() && (least == 0 || cells(path).len() < least) {
        assert!(start.elapsed() < Duration::from_secs(300), "{least} cells never came");
        if least == 0 {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn stop(child: &Child, signal: Signal) {
    let pid = Pid::from_child(child);
    // It may have ended by itself.
    let _ = kill_process(pid, signal);
}

fn complete(folder: &Folder) -> Record {
    let output = measure(folder, "3", &["--resume"]).output().expect("a process");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let record = read(&folder.path("record.json")).expect("a record");
    assert!(record.run.is_some_and(|run| run.complete));
    let mut names: Vec<_> =
        record.cells.iter().map(|c| format!("{} {} {}", c.scene, c.rays, c.structure)).collect();
    names.sort();
    let mut all = Vec::new();
    for scene in SCENES {
        for rays in RAYS {
            all.extend(STRUCTURES.map(|structure| format!("{scene} {rays} {structure}")));
        }
    }
    all.sort();
    assert_eq!(names, all, "every cell is there once");
    record
}

#[test]
fn killed_at_any_moment_it_goes_on() {
    let folder = Folder::new();
    let path = folder.path("record.json");
    let mut before = Vec::new();
    // At once, at the first sign of life, and while cells come and are written.
    for (least, after) in [(0, 0), (0, 40), (1, 0), (1, 3), (4, 1), (7, 0), (7, 7), (10, 2), (13, 0)] {
        let mut child = measure(&folder, "3", &["--resume"]).spawn().expect("a process");
        wait_for(&mut child, &path, least);
        std::thread::sleep(Duration::from_millis(after));
        stop(&child, Signal::KILL);
        child.wait().expect("a process");
        let now = cells(&path);
        assert!(now.len() >= least && goes_on(&before, &now), "what was there stays as it was");
        before = now;
    }
    assert!(before.len() >= 13);
    complete(&folder);
    assert!(goes_on(&before, &cells(&path)));
}

#[test]
fn stopped_by_the_user_it_says_how_to_go_on() {
    let folder = Folder::new();
    let path = folder.path("record.json");
    let interrupted = |more: &[&str], least: usize| -> Output {
        // Samples that take a while, so that there is something to interrupt.
        let mut child = measure(&folder, "10000", more).spawn().expect("a process");
        wait_for(&mut child, &path, least);
        stop(&child, Signal::INT);
        child.wait_with_output().expect("a process")
    };
    let output = interrupted(&[], 3);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("cells done by then") && said.trim_end().ends_with("--resume"), "{said}");
    let before = cells(&path);
    assert!(before.len() >= 3 && !read(&path).expect("a record").run.expect("a run").complete);

    let output = interrupted(&["--resume", "--json"], before.len() + 1);
    let said: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    if output.status.code() == Some(130) {
        assert_eq!(said["interrupted"], true);
    }
    complete(&folder);
    let all = cells(&path);
    assert!(goes_on(&before, &all));
    // With nothing left to do the record stays as it is.
    complete(&folder);
    assert_eq!(cells(&path), all);
}

#[test]
fn another_measurement_is_refused() {
    let folder = Folder::new();
    assert!(measure(&folder, "3", &[]).status().expect("a process").success());
    let output = measure(&folder, "3", &["--resume", "--seed", "7"]).output().expect("a process");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(said.contains("its seed was `1` and is `7`") && said.contains("--out another name"), "{said}");
}

/// A short measurement, in a shell that lets files grow to so many blocks of 512 bytes.
fn short(folder: &Folder, blocks: &str) -> Command {
    let mut command = Command::new("sh");
    command.env("RAYSCALE", env!("CARGO_BIN_EXE_rayscale")).current_dir(folder.folder());
    let words = "measure --scene unit-one --rays random,axis,parallel --size 8 --rounds 2 --passes 2 --structure ssm \
                 --structure bmssm --no-memory --out record.json --resume";
    // The signal that says that a file is too large is turned into an error.
    command.args(["-c", &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$RAYSCALE\" {words}")]);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// Cells of [`short`].
const CELLS: usize = 6;

/// Half of the moments are kills, at any time of the run; at the other half the disk is full, after any number of blocks.
/// `cargo xtask interrupt` asks for a thousand.
#[test]
fn at_random_moments_records_are_whole_and_completed() {
    let moments: u32 = std::env::var("RAYSCALE_MOMENTS").map_or(8, |text| text.parse().expect("a number"));
    let whole = || {
        let (begun, folder) = (Instant::now(), Folder::new());
        assert!(short(&folder, "unlimited").status().expect("a process").success());
        (begun.elapsed(), folder.read("record.json").len())
    };
    // The first is slower than others, which would be over before they are killed.
    let (time, size) = whole().min(whole());
    let mut random = scenes::Random::new(1);
    let (mut killed, mut full, mut partial) = (0, 0, 0);
    for moment in 0..moments {
        let folder = Folder::new();
        let path = folder.path("record.json");
        if moment % 2 == 0 {
            let mut child = short(&folder, "unlimited").spawn().expect("a process");
            std::thread::sleep(time.mul_f64(random.unit()));
            stop(&child, Signal::KILL);
            killed += u32::from(!child.wait().expect("a process").success());
        } else {
            let blocks = random.below(size / 512 + 2).to_string();
            let output = short(&folder, &blocks).output().expect("a process");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!([Some(0), Some(2)].contains(&output.status.code()), "{said}");
            assert!(!said.contains("panicked"), "{said}");
            full += u32::from(output.status.code() == Some(2));
        }
        let before = cells(&path);
        partial += u32::from(!before.is_empty() && before.len() < CELLS);
        let output = short(&folder, "unlimited").output().expect("a process");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let now = cells(&path);
        assert!(now.len() == CELLS && goes_on(&before, &now), "moment {moment}");
        assert!(read(&path).expect("a record").run.is_some_and(|run| run.complete));
    }
    println!(
        "{moments} moments: {killed} kills, {full} full disks, {partial} records of some cells; all whole and completed"
    );
    assert!(killed > 0 && full > 0);
}
