//! `cargo xtask structure`: which crate and which module imports which, and that no imports form a cycle.
//!
//! Crates are held to `layers.toml`. Within a crate, every folder is looked at by itself: its nodes are the
//! modules that lie directly in it, each with all it contains, and an arrow says that one names the other by
//! a path. A folder's own file and what lies in it are one node of the folder around it. Test code is left
//! out. What a method call reaches without naming it isn't seen.

mod arrows;
mod crates;
mod cycles;
mod layers;
mod modules;
mod resolve;
mod size;
mod syntax;

use std::fmt::Write;
use std::path::Path;

use arrows::Arrows;
use layers::Layers;
use modules::Tree;

const LAYERS: &str = include_str!("../../layers.toml");

/// What was found: every arrow, and what is wrong with them.
#[derive(Debug, Default)]
pub struct Findings {
    /// One line an arrow, by crate and folder.
    pub listing: String,
    /// One sentence a fault.
    pub faults: Vec<String>,
}

impl Findings {
    /// # Errors
    /// All faults, a line each.
    pub fn verdict(&self) -> Result<(), String> {
        if self.faults.is_empty() { Ok(()) } else { Err(self.faults.join("\n  ")) }
    }
}

/// Reads the crates of the workspace at `root` and judges them.
///
/// # Errors
/// Where `cargo metadata` fails or a source file can't be read.
pub fn examine(root: &Path) -> Result<Findings, String> {
    let layers: Layers = LAYERS.parse()?;
    let crates = crates::of_workspace(root)?;
    let mut findings = Findings::default();
    findings.take("crates", &crates::arrows(&crates));
    findings.faults.extend(layers.faults(&crates));
    for one in &crates {
        let mut lines = 0;
        for entry in &one.entries {
            let tree = Tree::read(entry)?;
            lines += tree.lines();
            for (folder, arrows) in arrows::of_tree(&tree) {
                findings.take(&format!("{}{folder}", one.name), &arrows);
            }
        }
        findings.faults.extend(size::fault(&one.name, lines));
        let _ = writeln!(findings.listing, "{}: {lines} lines without tests\n", one.name);
    }
    Ok(findings)
}

impl Findings {
    fn take(&mut self, place: &str, arrows: &Arrows) {
        if !arrows.is_empty() {
            let _ = writeln!(self.listing, "{place}\n{arrows}");
        }
        for cycle in cycles::of(arrows) {
            self.faults.push(format!("{place}: {cycle}"));
        }
    }
}
