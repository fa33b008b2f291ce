//! `cargo xtask setup`: everything that the workspace needs beyond Rust and a C toolchain.

use crate::embree::{self, Embree};
use crate::meshes::{self, Wanted};
use crate::places::{self, Places};

/// What set-up has found.
pub struct Ready {
    /// Whether Embree 4 can be linked with.
    pub embree: bool,
}

/// Finds or installs Embree, then the meshes. Idempotent, and quick when all is there.
///
/// # Errors
/// Only when `.setup` cannot be written: what cannot be had is recorded as missing.
pub fn run(places: &Places, wanted: Wanted) -> Result<Ready, String> {
    std::fs::create_dir_all(&places.setup)
        .map_err(|e| format!("cannot create {}: {e}", places.setup.display()))?;
    let embree = match embree::find_or_install(places) {
        Ok(embree) => {
            println!("Embree 4: {} ({})", embree.lib.display(), embree.source);
            record(places, &embree)?;
            places::remove(&places.embree_missing())?;
            true
        }
        Err(why) => {
            println!("Embree 4: skipped, {why}");
            places::remove(&places.embree_record())?;
            places::write(&places.embree_missing(), &format!("{why}\n"))?;
            false
        }
    };
    meshes::fetch_all(places, wanted)?;
    let scratch = places.setup.join("scratch");
    if scratch.exists() {
        std::fs::remove_dir_all(&scratch).map_err(|e| format!("cannot remove {}: {e}", scratch.display()))?;
    }
    Ok(Ready { embree })
}

/// Writes the record that the build script of `embree4-sys` reads; an unchanged record is left
/// alone, because a new time stamp would rebuild everything that links with Embree.
fn record(places: &Places, embree: &Embree) -> Result<(), String> {
    let text = format!("lib={}\nsource={}\n", embree.lib.display(), embree.source);
    let path = places.embree_record();
    if std::fs::read_to_string(&path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    places::write(&path, &text)
}
