//! Scene files with slips in them get the file, the line and the reason, and exit code 2.

use crate::common::{Folder, rayscale};
use predicates::prelude::*;
use predicates::str::contains;

const HEAD: &str = "id = 'a'\ndescription = 'b'\ncharacter = 'c'\n[[solid]]\n";

/// Fifteen points.
fn short_net() -> String {
    (0..15).map(|i| format!("[{}, {}, 0], ", i % 4, i / 4)).collect()
}

#[test]
fn each_slip_is_told_with_file_line_and_reason() {
    let folder = Folder::new();
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let unit = "min = [-1, -1, -1]\nmax = [1, 1, 1]\n";
    let ball = "kind = 'sphere'\ncenter = [0, 0, 0]\n";
    let implicit = "kind = 'implicit'\nfunction = ";
    for (what, solid, line, reason) in [
        ("an unknown kind", "kind = 'spher'\nradius = 1", 5, "did you mean `sphere`?"),
        (
            "a radius that is no number",
            &format!("{ball}radius = nan"),
            7,
            "`radius` is NaN, which is not finite",
        ),
        ("a negative radius", &format!("{ball}radius = -1"), 7, "`radius` must be above 0, not -1"),
        ("a function that can't be read", &format!("{implicit}'x^2 +* y'\n{unit}"), 6, "column 6"),
        ("a function of something else", &format!("{implicit}'x + w'\n{unit}"), 6, "`w`"),
        ("a function without bounds", &format!("{implicit}'x^2 + y^2 - z'"), 5, "`min` is missing"),
        (
            "a function with endless bounds",
            &format!("{implicit}'x'\nmin = [-inf, -1, -1]\nmax = [1, 1, 1]"),
            7,
            "`min` is -inf, which is not finite",
        ),
        (
            "a function with bounds the wrong way round",
            &format!("{implicit}'x'\nmin = [1, 1, 1]\nmax = [-1, -1, -1]"),
            7,
            "`min` must be below `max`",
        ),
        (
            "a patch with fifteen points",
            &format!("kind = 'patch'\npoints = [{}]", short_net()),
            6,
            "`points` must be 16 points of three numbers each; 15 are there",
        ),
        (
            "a set over an open mesh",
            "kind = 'csg'\ncombination = 'union'\nparts = [\n{ kind = 'sphere', center = [0, 0, 0], radius = 1 },\n\
             { kind = 'facets', file = 'open.obj' }]",
            7,
            "part 2 (facets): `file` is not closed",
        ),
        ("no kind", "radius = 1", 5, "`kind` is missing"),
        ("a slip of the format", "kind = 'sphere", 5, "TOML"),
    ] {
        let scene = folder.write("scene.toml", format!("{HEAD}{solid}"));
        let out = folder.write("out.png", "older picture");
        let mut command = rayscale(["render", "--structure", "brute", "--size", "8"]);
        let assert = command.arg(&scene).arg("--out").arg(&out).assert().code(2).stdout("");
        let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        for part in ["scene.toml", &format!("line {line}"), reason] {
            assert!(text.contains(part), "{what}: no {part:?} in {text}");
        }
        assert.stderr(contains("panicked").not());
        assert_eq!(folder.read("out.png"), "older picture", "{what}");
    }
}
