//! What an installed program needs and the checkout may not outlive: copies in the user's data folder.

use std::fs;
use std::path::{Path, PathBuf};

/// `rayscale` in the user's data folder (`$XDG_DATA_HOME`, else `~/.local/share`); none without a home.
pub fn folder() -> Option<PathBuf> {
    dirs::data_dir().map(|data| data.join("rayscale"))
}

/// Makes `to` hold the files of `from`, as further names of the same files where the file system can.
///
/// Files that are there with the same length stay: a program may be running with them.
///
/// # Errors
/// The file that cannot be written, and why.
pub fn files(from: &Path, to: &Path) -> Result<(), String> {
    let explain = |path: &Path, e: std::io::Error| format!("cannot write {}: {e}", path.display());
    fs::create_dir_all(to).map_err(|e| explain(to, e))?;
    for entry in fs::read_dir(from).map_err(|e| format!("cannot read {}: {e}", from.display()))?.flatten() {
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        if same(&source, &target) {
            continue;
        }
        crate::places::remove(&target)?;
        match fs::read_link(&source) {
            Ok(name) => link(&name, &target),
            Err(_) => fs::hard_link(&source, &target).or_else(|_| fs::copy(&source, &target).map(drop)),
        }
        .map_err(|e| explain(&target, e))?;
    }
    Ok(())
}

fn same(source: &Path, target: &Path) -> bool {
    match (fs::symlink_metadata(source), fs::symlink_metadata(target)) {
        (Ok(a), Ok(b)) => a.file_type() == b.file_type() && a.len() == b.len(),
        _ => false,
    }
}

#[cfg(unix)]
fn link(name: &Path, target: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(name, target)
}

#[cfg(not(unix))]
fn link(name: &Path, target: &Path) -> std::io::Result<()> {
    let from = target.parent().unwrap_or(target).join(name);
    fs::copy(from, target).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_outlive_their_source_and_follow_it() {
        let dir = tempfile::tempdir().unwrap();
        let (from, to) = (dir.path().join("from"), dir.path().join("user/to"));
        fs::create_dir(&from).unwrap();
        fs::write(from.join("lib.so.4"), "library").unwrap();
        #[cfg(unix)]
        link(Path::new("lib.so.4"), &from.join("lib.so")).unwrap();
        files(&from, &to).unwrap();
        files(&from, &to).unwrap();
        crate::places::remove(&from.join("lib.so.4")).unwrap();
        fs::write(from.join("lib.so.4"), "newer library").unwrap();
        files(&from, &to).unwrap();
        fs::remove_dir_all(&from).unwrap();
        assert_eq!(fs::read_to_string(to.join("lib.so.4")).unwrap(), "newer library");
        #[cfg(unix)]
        assert_eq!(fs::read_to_string(to.join("lib.so")).unwrap(), "newer library");
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file");
        fs::write(&file, "").unwrap();
        let why = files(dir.path(), &file.join("below")).unwrap_err();
        assert!(why.contains("file/below"), "{why}");
    }
}
