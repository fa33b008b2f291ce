//! Where results go: links, pipes, devices, names that are no Unicode, and places that nothing can be written to.

use crate::common::{Folder, OBJ, RAYS, rayscale};
use harness::output::Claim;
use predicates::prelude::*;
use predicates::str::contains;

/// `rayscale trace` of the two triangles into `out`.
fn trace(folder: &Folder, out: impl AsRef<std::ffi::OsStr>) -> assert_cmd::Command {
    folder.write("scene.obj", OBJ);
    folder.write("rays.csv", RAYS);
    let mut command =
        rayscale(["trace", "--structure", "brute", "--scene", "scene.obj", "--rays", "rays.csv"]);
    command.arg("--out").arg(out).current_dir(folder.folder());
    command
}

#[test]
fn an_hour_is_not_spent_on_what_has_no_place() {
    let folder = Folder::new();
    // What would be measured is told first of all, were there a place for it.
    let mut measure = rayscale(["measure", "--scene", "unit-one", "--out", "none/record.json"]);
    let told = measure.current_dir(folder.folder()).assert().code(2).stdout("");
    told.stderr(contains("none/record.json").and(contains("unit-one").not()));
    rayscale(["compare", "--full", "--scene", "unit-one", "--out", "file/out"])
        .current_dir(folder.write("file", "").parent().unwrap())
        .assert()
        .code(2)
        .stderr(contains("checking").not());
    trace(&folder, folder.folder()).assert().code(2).stderr(contains("directory"));
}

#[test]
fn two_runs_do_not_write_one_record() {
    let folder = Folder::new();
    let _other = Claim::of(&folder.path("record.json")).expect("nobody has it");
    rayscale(["measure", "--scene", "unit-one", "--out", "record.json"])
        .current_dir(folder.folder())
        .assert()
        .code(2)
        .stderr(contains("another run is writing").and(contains("--out another name")));
    assert!(!folder.path("record.json").exists());
}

#[test]
fn more_threads_than_there_can_be_are_refused() {
    for threads in ["18446744073709551615", "1025", "0", "-1"] {
        let option = format!("--threads={threads}");
        rayscale(["scenes", &option]).assert().code(2).stderr(contains("--threads"));
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::{FileTypeExt, PermissionsExt};

    #[test]
    fn names_that_are_no_unicode_are_names() {
        let folder = Folder::new();
        let name = |extension: &str| [&b"h\xff."[..], extension.as_bytes()].concat();
        let there = |extension: &str| folder.folder().join(OsStr::from_bytes(&name(extension))).exists();
        trace(&folder, OsStr::from_bytes(&name("csv"))).assert().code(0);
        trace(&folder, OsStr::from_bytes(&name("csv"))).arg("--json").assert().code(0);
        let run = |words: &[&str], extension: &str| {
            let mut command = rayscale(words);
            command.args(["--out".as_ref(), OsStr::from_bytes(&name(extension))]);
            command.arg("--json").current_dir(folder.folder()).assert().code(0);
            assert!(there(extension), "{extension}");
        };
        run(&["scenes", "export", "scene.obj"], "obj");
        run(&["render", "scene.obj", "--size", "4"], "png");
        run(
            &[
                "measure",
                "--scene",
                "unit-one",
                "--rays",
                "random",
                "--size",
                "4",
                "--structure",
                "ssm",
                "--no-memory",
            ],
            "json",
        );
        assert!(there("csv"));
    }

    #[test]
    fn devices_and_pipes_get_what_is_written() {
        let folder = Folder::new();
        trace(&folder, "/dev/null").assert().code(0);
        assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        trace(&folder, "/dev/stdout")
            .arg("--quiet")
            .assert()
            .code(0)
            .stdout(contains("ray,object,t,u,v\n0,2,2,"));
    }

    #[test]
    fn a_file_keeps_its_mode_and_a_link_its_end() {
        let folder = Folder::new();
        let file = folder.write("secret.csv", "old");
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o600)).unwrap();
        std::os::unix::fs::symlink("secret.csv", folder.path("link.csv")).unwrap();
        trace(&folder, "link.csv").assert().code(0);
        assert!(std::fs::symlink_metadata(folder.path("link.csv")).unwrap().is_symlink());
        assert_eq!(std::fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
        assert!(folder.read("secret.csv").starts_with("ray,"));
    }

    #[test]
    fn a_full_disk_leaves_what_was_there() {
        let folder = Folder::new();
        trace(&folder, "/dev/full").assert().code(2).stderr(contains("/dev/full"));
        folder.write("hits.csv", "old");
        folder.write("scene.obj", OBJ);
        folder.write("rays.csv", RAYS);
        // The shell lets files grow to no more than so many blocks; the signal that says so is turned into an error.
        let mut command = assert_cmd::Command::new("sh");
        command.env("RAYSCALE", env!("CARGO_BIN_EXE_rayscale")).current_dir(folder.folder());
        command.args(["-c", "trap '' XFSZ; ulimit -f 0; exec \"$RAYSCALE\" trace --structure brute --scene scene.obj --rays rays.csv --out hits.csv"]);
        command.assert().code(2).stderr(contains("hits.csv"));
        assert_eq!(folder.read("hits.csv"), "old");
        assert_eq!(std::fs::read_dir(folder.folder()).unwrap().count(), 3, "nothing is left over");
    }
}
