//! Whether `rayscale diff` tells noise from change on this machine, by real runs. Takes minutes, so it is asked for:
//! `cargo test --release -p rayscale --test cli -- --ignored --nocapture noise`
//!
//! The structures' places in the list choose who is slowed, so that every structure has its turn.

use crate::common::{Folder, rayscale};
use harness::changes::{Changes, changes};
use harness::record::{Record, read};

const PAIRS: usize = 20;
const PLANTED: f64 = 1.15;
const FEW: &[&str] = &["bmssm", "ssm", "ssm-list", "obvhs-bvh2", "obvhs-cwbvh", "embree", "embree-robust"];
const MANY: &[&str] = &["bmssm-dense", "embree-compact", "embree-packet"];

fn run(folder: &Folder, name: &str, structures: &[&str], rays: &str) -> Record {
    let path = folder.path(name);
    let mut command =
        rayscale(["measure", "--quiet", "--no-memory", "--scene", "small-10k", "--size", "128"]);
    command.args(["--rays", rays, "--rounds", "15", "--out"]).arg(&path);
    for id in structures {
        command.args(["--structure", id]);
    }
    command.assert().success();
    read(&path).expect("a record")
}

/// What is marked, in words.
fn marked(changes: &Changes) -> Vec<String> {
    let structures = changes.structures.iter().filter(|s| s.judged.beyond_noise);
    let structures = structures.map(|s| format!("{} {:.3}", s.structure, s.judged.relative()));
    let cells = changes.cells.iter().filter(|c| c.judged.beyond_noise);
    let cells = cells.map(|c| format!("{} {} {:.3}", c.structure, c.rays, c.judged.relative()));
    structures.chain(cells).collect()
}

fn load() -> String {
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    load.split(' ').next().unwrap_or_default().to_owned()
}

fn trial(structures: &[&str], rays: &str) {
    let folder = Folder::new();
    let (mut alarms, mut found, mut cells) = (0, 0, 0);
    for pair in 0..PAIRS {
        let before = run(&folder, "a.json", structures, rays);
        let mut after = run(&folder, "b.json", structures, rays);
        let all = changes(&before, &after);
        let flagged = marked(&all);
        cells = all.cells.len();
        alarms += usize::from(!flagged.is_empty());
        let slow = after.structures[pair % after.structures.len()].id.clone();
        for cell in after.cells.iter_mut().filter(|cell| cell.structure == slow) {
            cell.trace_ns.iter_mut().for_each(|ns| *ns = (*ns as f64 * PLANTED) as u64);
            cell.summarise();
        }
        let all = changes(&before, &after);
        let shift = all.structures.iter().find(|s| s.structure == slow).expect("in both");
        let slower = |c: &harness::changes::Judged| c.beyond_noise && c.ratio > 1.0;
        let seen =
            slower(&shift.judged) || all.cells.iter().any(|c| c.structure == slow && slower(&c.judged));
        found += usize::from(seen);
        println!(
            "pair {pair}, load {}: alarms {flagged:?}; 15 % in {slow}: {} ({:.3} in [{:.3}, {:.3}])",
            load(),
            if seen { "found" } else { "missed" },
            shift.judged.relative(),
            shift.judged.low,
            shift.judged.high
        );
    }
    println!("{cells} cells: {alarms} of {PAIRS} pairs raised an alarm; the slowdown was found in {found}");
    assert!(alarms <= 1, "{alarms} false alarms");
    assert!(found + 1 >= PAIRS, "{found} slowdowns found");
}

#[test]
#[ignore = "takes minutes"]
fn noise_is_no_change_and_15_percent_are_in_14_cells() {
    trial(FEW, "parallel,diffuse");
}

#[test]
#[ignore = "takes minutes"]
fn noise_is_no_change_and_15_percent_are_in_65_cells() {
    trial(&[FEW, MANY].concat(), "parallel,perspective,shadow,ambient,diffuse,random,axis");
}
