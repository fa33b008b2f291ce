//! The crates of the workspace, as cargo tells of them.

use std::path::{Path, PathBuf};

use cargo_metadata::{DependencyKind, MetadataCommand, TargetKind};

use super::arrows::Arrows;

/// A member of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Crate {
    /// The package's name.
    pub name: String,
    /// Other members that it is built with; those of its tests alone are left out.
    pub dependencies: Vec<String>,
    /// The root files of its library and programs.
    pub entries: Vec<PathBuf>,
}

/// Every member of the workspace at `root`, by name.
///
/// # Errors
/// One sentence where `cargo metadata` fails.
pub fn of_workspace(root: &Path) -> Result<Vec<Crate>, String> {
    let metadata = MetadataCommand::new()
        .manifest_path(root.join("Cargo.toml"))
        .no_deps()
        .exec()
        .map_err(|e| format!("cargo metadata failed: {e}"))?;
    let members = metadata.workspace_packages();
    let names: Vec<&str> = members.iter().map(|package| package.name.as_str()).collect();
    let mut crates: Vec<Crate> = members
        .iter()
        .map(|package| Crate {
            name: package.name.to_string(),
            dependencies: package
                .dependencies
                .iter()
                .filter(|d| d.kind == DependencyKind::Normal && names.contains(&d.name.as_str()))
                .map(|d| d.name.clone())
                .collect(),
            entries: package
                .targets
                .iter()
                .filter(|t| t.kind.iter().any(|kind| matches!(kind, TargetKind::Lib | TargetKind::Bin)))
                .map(|t| t.src_path.clone().into())
                .collect(),
        })
        .collect();
    crates.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(crates)
}

/// Which crate depends on which.
pub fn arrows(crates: &[Crate]) -> Arrows {
    let mut arrows = Arrows::default();
    for one in crates {
        for dependency in &one.dependencies {
            arrows.add(&one.name, dependency, "its manifest");
        }
    }
    arrows
}
