//! Bad input gets a message that says what, where and what to do, and exit code 2.

use crate::common::{Folder, OBJ, RAYS, rayscale};
use harness::registry::{self, Entry};
use predicates::prelude::*;
use predicates::str::contains;

/// Runs `render` on an OBJ file with this content; it must fail with this message and leave what was there.
fn refuses_obj(content: &[u8], messages: &[&str]) {
    let folder = Folder::new();
    let obj = folder.write("scene.obj", content);
    let out = folder.write("out.png", "older picture");
    let mut command = rayscale(["render"]);
    let mut assert = command.arg(&obj).arg("--out").arg(&out).args(["--structure", "brute"]).assert().code(2);
    for message in messages {
        assert = assert.stderr(contains(*message));
    }
    assert.stdout("").stderr(contains("scene.obj").and(contains("panicked").not()));
    assert_eq!(folder.read("out.png"), "older picture");
    assert_eq!(std::fs::read_dir(folder.folder()).unwrap().count(), 2, "no file is left over");
}

#[test]
fn files_that_are_missing_or_unreadable() {
    let folder = Folder::new();
    let rays = folder.write("rays.csv", RAYS);
    let trace = |scene: &str, rays: &std::path::Path| {
        let mut command = rayscale(["trace", "--structure", "brute", "--scene", scene, "--rays"]);
        command.arg(rays).args(["--out", "hits.csv"]).current_dir(folder.folder());
        command
    };
    trace("none.obj", &rays).assert().code(2).stderr(contains("none.obj").and(contains("No such file")));
    std::fs::create_dir(folder.path("folder.obj")).unwrap();
    trace("folder.obj", &rays).assert().code(2).stderr(contains("folder.obj"));
    folder.write("scene.obj", OBJ);
    trace("scene.obj", &folder.path("none.csv")).assert().code(2).stderr(contains("none.csv"));
    trace("scene.obj", folder.folder()).assert().code(2);
    assert!(!folder.path("hits.csv").exists());
}

#[test]
fn places_that_can_not_be_written() {
    let folder = Folder::new();
    let obj = folder.write("scene.obj", OBJ);
    let mut command = rayscale(["render", "--structure", "brute", "--size", "8", "--out"]);
    command.arg(folder.path("none/out.png")).arg(obj).assert().code(2).stderr(contains("none/out.png"));
}

#[test]
fn coordinates_that_are_not_finite() {
    refuses_obj(b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", &["line 2", "vertex 2", "nan"]);
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 -inf\nf 1 2 3\n", &["line 3", "vertex 3", "inf"]);
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 1e39\nf 1 2 3\n", &["line 3", "vertex 3"]);
    refuses_obj(b"v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n", &["line 2", "`x`"]);
}

#[test]
fn faces_that_name_no_vertex() {
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", &["line 4", "vertex 4", "3 vertices"]);
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", &["line 4", "-4"]);
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", &["line 4"]);
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", &["line 4"]);
}

#[test]
fn meshes_without_faces() {
    refuses_obj(b"", &["no faces"]);
    refuses_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", &["no faces"]);
    refuses_obj(b"hello world\n", &["no faces"]);
}

#[test]
fn garbage() {
    let mut state = 1u64;
    let mut byte = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 56) as u8
    };
    let noise: Vec<u8> = (0..5_000_000).map(|_| byte()).collect();
    refuses_obj(&noise, &["line 1"]);
    // Printable noise in lines, and one endless line.
    let letters: Vec<u8> = noise.iter().map(|b| if b % 64 == 0 { b'\n' } else { b' ' + b % 64 }).collect();
    refuses_obj(&letters, &[]);
    refuses_obj(&vec![b'v'; 5_000_000], &["line 1"]);
}

#[test]
fn names_that_nothing_has() {
    let folder = Folder::new();
    folder.write("scene.obj", OBJ);
    folder.write("rays.csv", RAYS);
    let trace = |more: &[&str]| {
        let mut command = rayscale(["trace", "--rays", "rays.csv", "--out", "hits.csv"]);
        command.args(more).current_dir(folder.folder()).assert().code(2)
    };
    trace(&["--scene", "scene.obj", "--structure", "minimax"])
        .stderr(contains("`minimax`").and(contains("minmax")));
    trace(&["--scene", "scene.obj", "--structure", "zzz"]).stderr(contains("rayscale structures"));
    trace(&["--scene", "scene.obj", "--structure", "brute", "--kernel", "watertigth"])
        .stderr(contains("`watertigth`").and(contains("watertight`?")));
    trace(&["--scene", "scene.obj", "--structure", "brute:kernal=watertight"]).stderr(contains("kernel"));
    trace(&["--scene", "scene.obj", "--structure", "brute:kernel=watertight", "--kernel", "moller-trumbore"])
        .stderr(contains("two kernels"));
    trace(&["--scene", "stadum", "--structure", "brute"])
        .stderr(contains("`stadum`").and(contains("stadium")));
    trace(&["--scene", "scene.stl", "--structure", "brute"]).stderr(contains("`scene.stl`"));
    assert!(!folder.path("hits.csv").exists());
}

#[test]
fn resolutions_that_can_not_be() {
    let folder = Folder::new();
    folder.write("scene.obj", OBJ);
    folder.write("rays.csv", RAYS);
    let trace = |structure: &str| {
        let mut command =
            rayscale(["trace", "--scene", "scene.obj", "--rays", "rays.csv", "--out", "hits.csv"]);
        command.args(["--structure", structure]).current_dir(folder.folder()).assert().code(2)
    };
    let takes_resolution = |e: &&Entry| e.settings.iter().any(|(name, _)| *name == "resolution");
    let structures: Vec<&str> = registry::entries().iter().filter(takes_resolution).map(|e| e.id).collect();
    assert!(structures.contains(&"ssm") && structures.contains(&"bmssm-dense"), "{structures:?}");
    for structure in structures {
        for resolution in ["0", "4x0x4", "-1", "many", "99999999999999999999"] {
            trace(&format!("{structure}:resolution={resolution}"))
                .stderr(contains(structure).and(contains("resolution")).and(contains("panicked").not()));
        }
    }
    // More than any machine's memory.
    for structure in ["ssm:resolution=16384", "ssm-list:resolution=16384"] {
        trace(structure).stderr(predicate::str::is_match("[0-9]{10,} bytes").unwrap());
    }
    assert!(!folder.path("hits.csv").exists());
}

#[test]
fn errors_are_json_when_results_are() {
    let out =
        rayscale(["scenes", "describe", "stadum", "--json"]).assert().code(2).get_output().stderr.clone();
    let error: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    assert!(error["error"].as_str().is_some_and(|text| text.contains("stadum")), "{error}");
    assert!(error["todo"].is_string(), "{error}");
}
