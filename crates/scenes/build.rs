//! Embeds the scene definitions.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Lists the definitions under `scenes/`: a scene is added by adding its file.
fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"))
        .join("../../scenes");
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut files: Vec<PathBuf> = fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let items: String = files
        .iter()
        .map(|path| format!("({:?}, include_str!({:?})),\n", name(path), path.display().to_string()))
        .collect();
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR")).join("definitions.rs");
    fs::write(&out, format!("&[\n{items}]")).unwrap_or_else(|error| panic!("{}: {error}", out.display()));
}
