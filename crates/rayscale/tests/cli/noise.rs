//! Whether `rayscale diff` tells noise from change on this machine, by real runs. Takes minutes, so it is asked for:
//! `cargo test --release -p rayscale --test cli -- --ignored --nocapture noise`

use crate::common::{Folder, rayscale};
use rayscale::changes::changes;
use rayscale::record::{Record, read};

const PAIRS: usize = 20;
const PLANTED: f64 = 1.15;

fn run(folder: &Folder, name: &str) -> Record {
    let path = folder.path(name);
    let mut command =
        rayscale(["measure", "--quiet", "--no-memory", "--scene", "small-10k", "--size", "128"]);
    command.args(["--rays", "parallel,diffuse", "--rounds", "15", "--out"]).arg(&path);
    for id in ["bmssm", "ssm", "ssm-list", "obvhs-bvh2", "obvhs-cwbvh"] {
        command.args(["--structure", id]);
    }
    command.assert().success();
    read(&path).expect("a record")
}

#[test]
#[ignore = "takes minutes and a machine without much else to do"]
fn noise_is_no_change_and_15_percent_are() {
    let folder = Folder::new();
    let (mut alarms, mut found, mut cells) = (0, 0, 0);
    for pair in 0..PAIRS {
        let (before, mut after) = (run(&folder, "a.json"), run(&folder, "b.json"));
        let all = changes(&before, &after);
        let flagged: Vec<_> = all.iter().filter(|change| change.beyond_noise).collect();
        cells += all.len();
        alarms += usize::from(!flagged.is_empty());
        // Another structure each time.
        let slow = after.structures[pair % after.structures.len()].id.clone();
        for cell in after.cells.iter_mut().filter(|cell| cell.structure == slow) {
            cell.trace_ns.iter_mut().for_each(|ns| *ns = (*ns as f64 * PLANTED) as u64);
            cell.summarise();
        }
        let seen =
            changes(&before, &after).iter().any(|c| c.structure == slow && c.beyond_noise && c.ratio > 1.0);
        found += usize::from(seen);
        println!(
            "pair {pair}: alarms {flagged:#?}; 15 % in {slow}: {}",
            if seen { "found" } else { "missed" }
        );
    }
    println!("{alarms} of {PAIRS} pairs ({cells} cells) raised an alarm; a slowdown was found in {found}");
    assert!(alarms <= 1, "{alarms} false alarms");
    assert!(found + 1 >= PAIRS, "{found} slowdowns found");
}
