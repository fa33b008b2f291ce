//! `rayscale trace` and the files it reads and writes.

use crate::common::{Folder, OBJ, RAYS, rayscale};
use predicates::prelude::*;

fn trace(folder: &Folder, more: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = rayscale(["trace", "--scene", "scene.obj", "--rays", "rays.csv", "--out", "hits.csv"]);
    command.current_dir(folder.folder()).args(more).assert()
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.obj", OBJ);
    folder.write("rays.csv", RAYS);
    folder
}

#[test]
fn hits_name_triangles_in_file_order_and_polygons_are_fanned() {
    let folder = folder();
    trace(&folder, &["--structure", "brute"]).success().stdout(predicate::str::contains("4 rays, 3 hits"));
    let hits = folder.read("hits.csv");
    let lines: Vec<&str> = hits.lines().collect();
    assert_eq!(lines[0], "ray,object,t,u,v");
    assert_eq!(lines[1], "0,2,2,0.25,0.25");
    // The fan of the quad 1 2 3 4 is (1 2 3), (1 3 4); t is in units of the direction.
    assert_eq!(lines[2], "1,0,1.5,0.25,0.5");
    assert!(lines[3].starts_with("2,0,3,") || lines[3].starts_with("2,1,3,"), "{}", lines[3]);
    assert_eq!(lines[4], "3,,,,");
    assert_eq!(lines.len(), 5);
}

#[test]
fn structures_and_kernels_agree() {
    let folder = folder();
    trace(&folder, &["--structure", "brute"]).success();
    let expected = folder.read("hits.csv");
    for structure in ["minmax", "sphere", "brute:simd=portable"] {
        trace(&folder, &["--structure", structure, "--quiet"]).success();
        assert_eq!(folder.read("hits.csv"), expected, "{structure}");
    }
    trace(&folder, &["--structure", "minmax", "--kernel", "watertight"]).success();
    assert_eq!(folder.read("hits.csv").lines().count(), 5);
}

#[test]
fn all_crossings_are_told_in_order() {
    let folder = folder();
    folder.write("rays.csv", "0.5,0.5,-1,0,0,1,0,inf\n9,9,9,0,0,1,0,inf\n");
    trace(&folder, &["--structure", "brute", "--kernel", "exact", "--all"]).success();
    let expected = folder.read("hits.csv");
    let lines: Vec<&str> = expected.lines().collect();
    assert!(lines.len() > 3, "a ray through a diagonal crosses both halves: {expected}");
    assert_eq!(lines.last(), Some(&"1,,,,"));
    let at = |line: &&str| line.split(',').nth(2).map(|t| t.parse::<f32>().expect("t"));
    assert!(lines[1..lines.len() - 1].iter().map(at).is_sorted());
    for structure in ["bmssm", "bmssm-dense", "ssm", "ssm-list", "minmax"] {
        trace(&folder, &["--structure", structure, "--kernel", "exact", "--all"]).success();
        assert_eq!(folder.read("hits.csv"), expected, "{structure}");
    }
    trace(&folder, &["--structure", "obvhs-bvh2", "--all"])
        .success()
        .stderr(predicate::str::contains("nearest"));
}

#[test]
fn json_says_what_was_done() {
    let folder = folder();
    let out = trace(&folder, &["--structure", "minmax", "--json"]).success().get_output().stdout.clone();
    let facts: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    assert_eq!((facts["rays"].as_u64(), facts["hits"].as_u64()), (Some(4), Some(3)));
    assert_eq!(facts["kernel"], "moller-trumbore");
}

#[test]
fn a_kernel_left_to_the_suite_is_chosen_by_the_errors_allowed() {
    let folder = folder();
    let kernel = |more: &[&str]| {
        let all = [&["--structure", "ssm", "--json"], more].concat();
        let out = trace(&folder, &all).success().get_output().stdout.clone();
        let facts: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
        (facts["kernel"].as_str().unwrap().to_owned(), facts["kernel_reason"].as_str().unwrap().to_owned())
    };
    let (proven, why) = kernel(&["--kernel", "auto", "--max-error", "0"]);
    assert_eq!(proven, "exact");
    assert!(why.contains("proven"), "{why}");
    let (cheapest, why) = kernel(&["--kernel", "auto", "--max-error", "1000000"]);
    // Which is the cheapest is a matter of time, but not that its time was taken.
    assert!(why.contains(&format!("{cheapest} takes")), "{why}");
    assert_eq!(kernel(&["--kernel", "exact"]).1, "");
    trace(&folder, &["--structure", "ssm", "--max-error", "1"]).code(2);
    trace(&folder, &["--structure", "ssm", "--kernel", "auto", "--max-error", "-1"]).code(2);
}

#[test]
fn a_record_says_which_kernel_was_chosen_and_why() {
    let folder = folder();
    let mut command =
        rayscale(["measure", "--scene", "scene.obj", "--rays", "random", "--size", "8", "--rounds", "1"]);
    command.args([
        "--structure",
        "ssm",
        "--structure",
        "minmax:kernel=watertight",
        "--kernel",
        "auto",
        "--no-memory",
    ]);
    command
        .args(["--max-error", "0", "--out", "record.json"])
        .current_dir(folder.folder())
        .assert()
        .success();
    let record: serde_json::Value = serde_json::from_str(&folder.read("record.json")).expect("JSON");
    let cells = record["cells"].as_array().unwrap();
    assert_eq!((&cells[0]["structure"], &cells[0]["kernel"]), (&"ssm:kernel=auto".into(), &"exact".into()));
    assert!(cells[0]["kernel_reason"].as_str().unwrap().contains("proven"), "{}", cells[0]);
    assert!(cells[1]["kernel"] == "watertight" && cells[1].get("kernel_reason").is_none());
}

#[test]
fn a_malformed_ray_is_named_and_older_hits_stay() {
    for (rays, message) in [
        ("0,0,3,0,0,-1,0,inf\n0,0,3,0,0,oops,0,inf\n", "line 2, field `dz`: `oops`"),
        ("0,0,3,0,0,-1,0,inf\n\n0,0,3,0,0,-1,0\n", "line 3: 7 fields"),
        (
            "0,0,3,0,0,-1,0,inf\n0,0,3,0,0,0,0,inf\n",
            "line 2, fields `dx`, `dy`, `dz`: the ray's direction is zero",
        ),
        ("NaN,0,3,0,0,-1,0,inf\n", "line 1, fields `ox`, `oy`, `oz`"),
        ("0,0,3,0,inf,-1,0,inf\n", "line 1, fields `dx`, `dy`, `dz`"),
        ("0,0,3,0,0,-1,nan,inf\n", "line 1, fields `t_min`, `t_max`"),
        ("x,y\n", "line 1: the header must be"),
    ] {
        let folder = folder();
        folder.write("rays.csv", rays);
        folder.write("hits.csv", "older hits");
        trace(&folder, &["--structure", "brute"])
            .code(2)
            .stdout("")
            .stderr(predicate::str::contains("rays.csv, ").and(predicate::str::contains(message)))
            .stderr(predicate::str::contains("to do:"));
        assert_eq!(folder.read("hits.csv"), "older hits");
        assert_eq!(std::fs::read_dir(folder.folder()).unwrap().count(), 3, "no file is left over");
    }
}

#[test]
fn hits_do_not_replace_the_rays() {
    let folder = folder();
    trace(&folder, &["--structure", "brute", "--rays", "hits.csv"]).code(2);
    let mut command =
        rayscale(["trace", "--scene", "scene.obj", "--rays", "rays.csv", "--out", "./rays.csv"]);
    command.current_dir(folder.folder()).args(["--structure", "brute"]).assert().code(2);
    assert_eq!(folder.read("rays.csv"), RAYS);
}

/// Two triangles in each place: nothing more shows than on one, and the same is recommended to be accurate enough.
#[test]
fn doubled_triangles_are_no_errors_unless_it_matters_which_is_hit() {
    let folder = folder();
    let doubled = folder.read("scene.obj");
    let faces: String =
        doubled.lines().filter(|line| line.starts_with('f')).map(|line| format!("{line}\n")).collect();
    folder.write("doubled.obj", format!("{doubled}\n{faces}"));
    let fitting = |scene: &str, more: &[&str]| {
        let mut command = rayscale(["recommend", scene, "--rays", "random", "--max-error", "100", "--json"]);
        let out =
            command.args(more).current_dir(folder.folder()).assert().success().get_output().stdout.clone();
        let facts: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
        let list = facts["recommendation"]["fitting"].as_array().unwrap().clone();
        let mut names: Vec<String> =
            list.iter().map(|c| c["structure"].as_str().unwrap().to_owned()).collect();
        names.sort();
        names
    };
    assert_eq!(fitting("scene.obj", &[]), fitting("doubled.obj", &[]));
}
