//! Which packages there are, and where things lie inside the checkout.

use std::path::{Path, PathBuf};

/// What must build and pass on a machine without Embree or any C++.
pub const CORE: [&str; 8] = [
    "rayscale-accel",
    "rayscale-lanes",
    "rayscale-solids",
    "rayscale-primitives",
    "rayscale-oracle",
    "rayscale-baselines",
    "bmssm",
    "rayscale-ssm",
];

/// The checkout and the folder `.setup` in it, which git ignores.
pub struct Places {
    /// Folder of the workspace's `Cargo.toml`.
    pub root: PathBuf,
    /// Everything that set-up writes.
    pub setup: PathBuf,
}

impl Places {
    /// The checkout that `cargo xtask` was called in.
    pub fn of_this_checkout() -> Self {
        // The value at run time follows a checkout that was moved after xtask was compiled.
        let package =
            std::env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| env!("CARGO_MANIFEST_DIR").to_owned());
        let package = PathBuf::from(package);
        let root = package.ancestors().nth(2).map_or_else(|| package.clone(), Path::to_path_buf);
        let setup = root.join(".setup");
        Self { root, setup }
    }

    /// `lib=DIR` and `source=TEXT` of the Embree that the workspace is linked with.
    pub fn embree_record(&self) -> PathBuf {
        self.setup.join("embree.txt")
    }

    /// Why there is no Embree; absent when there is one.
    pub fn embree_missing(&self) -> PathBuf {
        self.setup.join("embree-missing.txt")
    }

    /// Where programs compiled for this machine go.
    pub fn native_target(&self) -> PathBuf {
        let target =
            std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| self.root.join("target"), PathBuf::from);
        target.join("native")
    }

    /// The fetched meshes and their `status.txt`.
    pub fn meshes(&self) -> PathBuf {
        self.setup.join("meshes")
    }

    /// An empty folder for downloads under way.
    pub fn scratch(&self, name: &str) -> Result<PathBuf, String> {
        let dir = self.setup.join("scratch").join(name);
        if dir.exists() {
            std::fs::remove_dir_all(&dir).map_err(|e| format!("cannot empty {}: {e}", dir.display()))?;
        }
        std::fs::create_dir_all(&dir).map_err(|e| format!("cannot create {}: {e}", dir.display()))?;
        Ok(dir)
    }
}

/// Writes a file whole or not at all.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    let part = path.with_extension("part");
    std::fs::write(&part, text)
        .and_then(|()| std::fs::rename(&part, path))
        .map_err(|e| format!("cannot write {}: {e}", path.display()))
}

/// Removes a file that may not be there.
pub fn remove(path: &Path) -> Result<(), String> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(format!("cannot remove {}: {e}", path.display()))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_core_needs_no_package_of_the_workspace_outside_itself() {
        let root = Places::of_this_checkout().root;
        let metadata = cargo_metadata::MetadataCommand::new().current_dir(root).no_deps().exec().unwrap();
        for package in metadata.packages.iter().filter(|package| CORE.contains(&package.name.as_str())) {
            for needed in package.dependencies.iter().filter(|needed| needed.path.is_some()) {
                assert!(CORE.contains(&needed.name.as_str()), "{} needs {}", package.name, needed.name);
            }
        }
    }
}
