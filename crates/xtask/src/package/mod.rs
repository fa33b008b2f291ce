//! `cargo xtask package`: the crates meant for others are packaged, and a program that knows nothing of this
//! checkout is built on what is in the packages.

use std::path::Path;
use std::process::Command;

use crate::places::{CORE, Places, write};
use crate::shell::{cargo, output};

/// A program of at most ten lines that traces a mesh.
const TRACE: &str = include_str!("trace.rs.txt");

/// One that hands over meshes that can't be traced.
const ERRORS: &str = include_str!("errors.rs.txt");

/// One with objects of a kind of its own.
const KIND: &str = include_str!("kind.rs.txt");

/// What [`TRACE`] depends on in the end: it names the last only.
const NEEDED: [&str; 5] =
    ["rayscale-accel", "rayscale-lanes", "rayscale-solids", "rayscale-primitives", "bmssm"];

/// Packages, unpacks, builds and runs; says what was seen.
///
/// # Errors
/// A package that is incomplete, or a program that doesn't do what it should.
pub fn run(places: &Places) -> Result<String, String> {
    let mut package = cargo();
    package.current_dir(&places.root).args(["package", "--offline", "--allow-dirty", "--no-verify"]);
    output(package.args(CORE.map(|name| format!("-p{name}"))))?;
    let packages = target(places)?.join("package");
    let folder = tempfile::tempdir().map_err(|e| format!("no temporary folder: {e}"))?;
    let folder = folder.path();
    let mut patches = String::new();
    for name in CORE {
        let file = packages.join(format!("{name}-{VERSION}.crate"));
        output(Command::new("tar").arg("-xzf").arg(&file).arg("-C").arg(folder))?;
        complete(&folder.join(format!("{name}-{VERSION}")))?;
        if NEEDED.contains(&name) {
            patches += &format!("{name} = {{ path = \"../{name}-{VERSION}\" }}\n");
        }
    }
    let outside = folder.join("outside");
    std::fs::create_dir_all(outside.join("src/bin")).map_err(|e| format!("cannot create a folder: {e}"))?;
    write(&outside.join("Cargo.toml"), &manifest(&patches))?;
    write(&outside.join("src/bin/trace.rs"), TRACE)?;
    write(&outside.join("src/bin/errors.rs"), ERRORS)?;
    write(&outside.join("src/bin/kind.rs"), KIND)?;
    // The versions that are here already.
    std::fs::copy(places.root.join("Cargo.lock"), outside.join("Cargo.lock"))
        .map_err(|e| format!("cannot copy Cargo.lock: {e}"))?;
    let program = |name: &str| {
        let mut run = cargo();
        run.current_dir(&outside).env("CARGO_TARGET_DIR", packages.join("outside"));
        output(run.args(["run", "--quiet", "--offline", "--bin", name]))
    };
    let seen = program("trace")? + &program("errors")? + &program("kind")?;
    for expected in EXPECTED {
        if !seen.contains(expected) {
            return Err(format!(
                "the program outside of the workspace did not print '{expected}' but:\n{seen}"
            ));
        }
    }
    Ok(seen)
}

/// The version of all crates of the workspace.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What the programs must print.
const EXPECTED: [&str; 4] = [
    "Some(Hit { t: 1.0, object: 0, ",
    "triangle 0 names position 3, but there are 3 positions",
    "position 1 is [0, NaN, 0], which is not finite",
    "rays hit capsules, 2000 as brute force does",
];

fn manifest(patches: &str) -> String {
    format!(
        "[package]\nname = \"outside\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
         [dependencies]\nbmssm = \"{VERSION}\"\n\n\
         # Compiled for one run: nobody looks for lines in it.\n[profile.dev]\ndebug = false\n\n\
         [patch.crates-io]\n{patches}"
    )
}

/// Whether a package holds what its readers look for.
fn complete(package: &Path) -> Result<(), String> {
    for name in ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "src/lib.rs"] {
        if !package.join(name).is_file() {
            return Err(format!("{} lacks {name}", package.display()));
        }
    }
    Ok(())
}

fn target(places: &Places) -> Result<std::path::PathBuf, String> {
    let metadata = cargo_metadata::MetadataCommand::new().current_dir(&places.root).no_deps().exec();
    metadata.map(|metadata| metadata.target_directory.into()).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_program_is_of_ten_lines() {
        assert!(TRACE.lines().count() <= 10, "{TRACE}");
    }

    #[test]
    fn an_incomplete_package_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("README.md"), "").unwrap();
        assert!(complete(folder.path()).unwrap_err().ends_with("lacks LICENSE-MIT"));
    }
}
