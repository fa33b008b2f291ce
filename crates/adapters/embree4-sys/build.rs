//! Finds Embree 4 for the linker and for the loader.
//!
//! The library is where `cargo xtask setup` recorded it (`.setup/embree.txt`), else in a folder that
//! the system's linker searches. Dependents that make binaries get the folder as
//! `DEP_EMBREE4_LIBDIR`, because link arguments reach the targets of this package only.

use std::path::{Path, PathBuf};

const LINK_NAME: &str = "libembree4.so";

fn main() {
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let record = package.join("../../../.setup/embree.txt");
    println!("cargo::rerun-if-changed=build.rs");
    let found = if record.exists() {
        // Named only where it exists: cargo runs a script anew each time for a file that does not.
        println!("cargo::rerun-if-changed={}", record.display());
        recorded(&record)
    } else {
        on_this_system()
    };
    let Some(dir) = found else {
        println!(
            "cargo::error=Embree 4 was not found: run `cargo xtask setup` once (or build the \
             package rayscale with --no-default-features to do without Embree)"
        );
        return;
    };
    println!("cargo::rerun-if-changed={}", dir.join(LINK_NAME).display());
    println!("cargo::metadata=LIBDIR={}", dir.display());
    println!("cargo::rustc-link-arg=-Wl,-rpath,{}", dir.display());
    println!("cargo::rustc-link-search=native={}", dir.display());
    println!("cargo::rustc-link-lib=dylib=embree4");
    if let Some(out) = std::env::var_os("OUT_DIR") {
        show_to_cargo(&dir, Path::new(&out));
    }
}

fn recorded(record: &Path) -> Option<PathBuf> {
    let text = std::fs::read_to_string(record).ok()?;
    let dir = PathBuf::from(text.lines().find_map(|line| line.strip_prefix("lib="))?);
    dir.join(LINK_NAME).exists().then_some(dir)
}

fn on_this_system() -> Option<PathBuf> {
    let arch = std::env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    [
        format!("/usr/lib/{arch}-linux-gnu"),
        "/usr/local/lib".to_owned(),
        "/usr/local/lib64".to_owned(),
        "/usr/lib64".to_owned(),
        "/usr/lib".to_owned(),
    ]
    .into_iter()
    .map(PathBuf::from)
    .find(|dir| dir.join(LINK_NAME).exists())
}

/// Links the libraries into the output folder. Cargo puts search folders inside the target folder,
/// and no others, on the loader's path of what it runs itself; that serves the doc tests, benches
/// and tests of every package that links with this one, which get no link arguments from here.
fn show_to_cargo(dir: &Path, out: &Path) {
    if dir.starts_with("/usr") {
        return;
    }
    #[cfg(unix)]
    for entry in std::fs::read_dir(dir).into_iter().flatten().flatten() {
        let link = out.join(entry.file_name());
        // A stale link would point into a folder that is gone; a missing one shows when loading.
        let _ = std::fs::remove_file(&link);
        let _ = std::os::unix::fs::symlink(entry.path(), &link);
    }
    println!("cargo::rustc-link-search=native={}", out.display());
}
