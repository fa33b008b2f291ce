//! Tells records what they say of the program: commit, profile, compiler and its flags.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // As it is now, not where this was compiled: a checkout may have been moved or copied with its target folder.
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"))
        .join("../..");
    why_no_embree(&root);
    let git = |args: &[&str]| {
        let output = Command::new("git").arg("-C").arg(&root).args(args).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_default();
    let dirty =
        git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|files| !files.is_empty());
    // Named only where it exists: cargo runs a script anew each time for a file that does not.
    if let Some(log) =
        git(&["rev-parse", "--git-path", "logs/HEAD"]).map(|log| root.join(log)).filter(|l| l.exists())
    {
        println!("cargo::rerun-if-changed={}", log.display());
    }
    let rustc = env::var_os("RUSTC").and_then(|rustc| Command::new(rustc).arg("--version").output().ok());
    let rustc =
        rustc.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    println!("cargo::rustc-env=RAYSCALE_GIT={commit}{}", if dirty { "+" } else { "" });
    println!("cargo::rustc-env=RAYSCALE_RUSTC={rustc}");
    println!("cargo::rustc-env=RAYSCALE_PROFILE={}", env::var("PROFILE").unwrap_or_default());
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default().replace('\u{1f}', " ");
    println!("cargo::rustc-env=RAYSCALE_RUSTFLAGS={flags}");
}

/// What set-up wrote down where it found no Embree.
fn why_no_embree(root: &Path) {
    let note = root.join(".setup/embree-missing.txt");
    let Ok(text) = std::fs::read_to_string(&note) else { return };
    println!("cargo::rerun-if-changed={}", note.display());
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    println!("cargo::rustc-env=RAYSCALE_EMBREE_MISSING={line}");
}
