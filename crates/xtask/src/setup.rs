//! `cargo xtask setup`: everything that the workspace needs beyond Rust and a C toolchain.

use crate::embree::{self, Embree};
use crate::meshes::{self, Wanted};
use crate::places::{self, Places};
use crate::share;

/// What set-up has found.
pub struct Ready {
    /// Whether Embree 4 can be linked with.
    pub embree: bool,
}

/// Finds or installs Embree, then the meshes; what installed programs need goes into the user's data
/// folder too. Idempotent, and quick when all is there.
///
/// # Errors
/// Only when `.setup` cannot be written: what cannot be had is recorded as missing.
pub fn run(places: &Places, wanted: Wanted) -> Result<Ready, String> {
    std::fs::create_dir_all(&places.setup)
        .map_err(|e| format!("cannot create {}: {e}", places.setup.display()))?;
    let embree = match embree::find_or_install(places) {
        Ok(embree) => {
            let embree = outliving(places, embree);
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
    if let Some(Err(why)) = share::folder().map(|user| share::files(&places.meshes(), &user.join("meshes"))) {
        println!("an installed rayscale will not find the meshes: {why}");
    }
    let scratch = places.setup.join("scratch");
    if scratch.exists() {
        std::fs::remove_dir_all(&scratch).map_err(|e| format!("cannot remove {}: {e}", scratch.display()))?;
    }
    Ok(Ready { embree })
}

/// Has programs load Embree from the user's data folder where set-up brought it itself: what
/// `cargo install` installs has to run without this checkout.
fn outliving(places: &Places, embree: Embree) -> Embree {
    if !embree.lib.starts_with(&places.setup) {
        return embree;
    }
    let Some(user) = share::folder().map(|user| user.join(embree::FOLDER)) else { return embree };
    match share::files(&embree.lib, &user) {
        Ok(()) => Embree { lib: user, ..embree },
        Err(why) => {
            println!("an installed rayscale will need this checkout: {why}");
            embree
        }
    }
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
