//! `rayscale render`, `scenes` and `structures`.

use crate::common::{Folder, OBJ, rayscale};
use predicates::prelude::*;
use predicates::str::contains;

#[test]
fn pictures_have_the_size_asked_for_and_show_the_scene() {
    let folder = Folder::new();
    folder.write("scene.obj", OBJ);
    for (projection, shade) in
        [("perspective", "light"), ("parallel", "normal"), ("parallel", "depth"), ("perspective", "object")]
    {
        let mut command = rayscale(["render", "scene.obj", "--out", "out.png", "--size", "40x30"]);
        command.args(["--structure", "minmax", "--projection", projection, "--shade", shade]);
        command.current_dir(folder.folder()).assert().success().stdout(contains("40 × 30 pixels"));
        let picture = image::open(folder.path("out.png")).expect("a PNG").into_rgba8();
        assert_eq!(picture.dimensions(), (40, 30));
        let drawn = picture.pixels().filter(|p| p.0[3] == 255).count();
        assert!((100..1150).contains(&drawn), "{projection} {shade}: {drawn} pixels");
    }
}

#[test]
fn equal_structures_have_no_difference_and_different_ones_end_with_1() {
    let folder = Folder::new();
    let render = |scene: &str, structure: &str, against: &str| {
        let mut command = rayscale(["render", scene, "--out", "out.png", "--size", "64", "--json"]);
        command.args(["--structure", structure, "--against", against]);
        command.current_dir(folder.folder()).assert()
    };
    render("bumps-2k", "minmax", "brute").code(0).stdout(contains("\"missed\": 0"));
    // Another kernel rounds otherwise.
    let out = render("bumps-2k", "minmax:kernel=watertight", "brute").code(1).get_output().stdout.clone();
    let facts: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    let count = |kind: &str| facts["differences"][kind].as_u64().expect("a count");
    let total = ["missed", "invented", "object", "place"].map(count).iter().sum::<u64>();
    assert!(total > 0);
    let picture = image::open(folder.path("out.png")).expect("a PNG").into_rgba8();
    let coloured = picture.pixels().filter(|p| p.0[0] != p.0[1] || p.0[1] != p.0[2]).count();
    assert_eq!(coloured as u64, total, "every differing pixel is in colour");
}

#[test]
fn pictures_are_judged_by_exact_arithmetic() {
    let folder = Folder::new();
    let judged = |structure: &str| {
        let mut command = rayscale(["render", "bumps-2k", "--out", "out.png", "--size", "64", "--json"]);
        command.args(["--structure", structure, "--against", "exact"]).current_dir(folder.folder()).assert()
    };
    let wrong = |out: &[u8]| serde_json::from_slice::<serde_json::Value>(out).expect("JSON")["wrong"].clone();
    let right = judged("bmssm:kernel=exact").code(0).get_output().stdout.clone();
    assert_eq!((&wrong(&right)["colours"], &wrong(&right)["depth_largest"]), (&0.into(), &0.0.into()));
    assert!(folder.path("out.picture.png").exists());
    // A box in place of every triangle shows.
    let boxes = wrong(&judged("ssm:kernel=box").code(1).get_output().stdout.clone());
    let counts = &boxes["counts"];
    assert!(counts["phantoms"].as_u64() > Some(100) && counts["rays"] == 64 * 64, "{boxes}");
    assert!(boxes["shading_largest"].as_f64() > Some(10.0), "{boxes}");
}

#[test]
fn scenes_are_listed_described_and_exported() {
    let folder = Folder::new();
    rayscale(["scenes"]).assert().success().stdout(contains("stadium").and(contains("small-{objects}")));
    rayscale(["scenes", "describe", "small-100"]).assert().success().stdout(contains("100 triangles"));
    let mut export = rayscale(["scenes", "export", "small-100", "--out", "small.obj"]);
    export.current_dir(folder.folder()).assert().success();
    let describe = |scene: &str| {
        let mut command = rayscale(["scenes", "describe", scene, "--json"]);
        let out = command.current_dir(folder.folder()).assert().success().get_output().stdout.clone();
        serde_json::from_slice::<serde_json::Value>(&out).expect("JSON")
    };
    let (original, exported) = (describe("small-100"), describe("small.obj"));
    assert_eq!(original["checksum"], exported["checksum"], "nothing is lost on the way through OBJ");
    assert_eq!(exported["objects"], 100);
}

#[test]
fn structures_are_listed_with_their_settings() {
    rayscale(["structures"]).assert().success().stdout(contains("brute").and(contains("kernel")));
}
