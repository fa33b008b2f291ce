//! `--json` and `--quiet` mean the same for every verb: one JSON value on standard output, silence on the other.

use crate::common::{Folder, OBJ, RAYS, rayscale};
use serde_json::Value;

/// Every verb but `help`, on as little as it takes, in this order.
const VERBS: &[&str] = &[
    "measure --scene unit-one --rays random --size 16 --structure ssm --structure minmax --no-memory --out a.json",
    "compare --scene unit-one --rays random --size 16 --structure ssm --out compared",
    "check --scene unit-one --rays random --size 16 --structure ssm",
    "report a.json --out reported",
    "cmp a.json",
    "rank a.json --to ssm",
    "diff a.json a.json --all",
    "recommend unit-one --rays random",
    "render unit-one --size 16 --out picture.png",
    "trace --scene model.obj --rays rays.csv --structure ssm --out hits.csv",
    "scenes",
    "scenes describe unit-one",
    "scenes export unit-one --out unit.obj",
    "structures",
    "trade --scene unit-one --size 16 --judged 8 --rounds 1 --structure ssm --out traded",
    "model lattice-true --pixels 16 --levels 1 --list 4 --rounds 1",
    "completions bash",
];

#[test]
fn every_verb_prints_one_json_value_and_nothing_else() {
    let folder = Folder::new();
    folder.write("model.obj", OBJ);
    folder.write("rays.csv", RAYS);
    let paper = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reports/paper/paper.json");
    let paper = format!("paper --from {paper} --out paper");
    for line in VERBS.iter().copied().chain([paper.as_str()]) {
        let mut command = rayscale(line.split(' '));
        let output =
            command.args(["--json", "--quiet"]).current_dir(folder.folder()).output().expect("output");
        let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(0), "{line}: {out}{err}");
        let value: Result<Value, _> = serde_json::from_str(&out);
        assert!(value.is_ok_and(|v| v.is_object() || v.is_array()), "{line}: {out}");
        assert_eq!(err, "", "{line}");
    }
}

#[test]
fn no_verb_is_forgotten() {
    let output = rayscale(["--json"]).output().expect("output").stdout;
    let value: Value = serde_json::from_slice(&output).expect("JSON");
    for verb in value["verbs"].as_array().expect("verbs") {
        let name = verb["verb"].as_str().expect("a name");
        let tried = VERBS.iter().any(|line| line.split(' ').next() == Some(name));
        assert!(tried || ["paper", "help"].contains(&name), "{name}");
    }
}
