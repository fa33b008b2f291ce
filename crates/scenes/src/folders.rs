//! Where definitions and meshes are looked for.

use std::env;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Folders that take the place of the usual ones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folders {
    /// Definitions; otherwise the folder that `RAYSCALE_SCENES` names, or `./scenes` if there is one.
    pub scenes: Option<PathBuf>,
    /// Meshes; otherwise the folder that `RAYSCALE_MESHES` names, or else `.setup/meshes` here or in a folder
    /// above, then `rayscale/meshes` in the user's data folder.
    pub meshes: Option<PathBuf>,
}

static CHOSEN: OnceLock<Folders> = OnceLock::new();

/// Has this program look in these folders. Called before the first scene is asked for; later calls do nothing.
pub fn look_in(folders: Folders) {
    // The first call is what counts.
    let _ = CHOSEN.set(folders);
}

fn chosen(pick: impl Fn(&Folders) -> Option<PathBuf>, variable: &str) -> Option<PathBuf> {
    CHOSEN.get().and_then(pick).or_else(|| env::var_os(variable).map(PathBuf::from))
}

/// The folder whose definitions go before those of the program.
pub(crate) fn scenes() -> Option<PathBuf> {
    let here = || Some(PathBuf::from("scenes")).filter(|folder| folder.is_dir());
    chosen(|folders| folders.scenes.clone(), "RAYSCALE_SCENES").or_else(here)
}

/// The folders of meshes, in the order in which they are searched.
fn meshes() -> Vec<PathBuf> {
    if let Some(folder) = chosen(|folders| folders.meshes.clone(), "RAYSCALE_MESHES") {
        return vec![folder];
    }
    let here = env::current_dir().unwrap_or_default();
    let set_up = here.ancestors().map(|folder| folder.join(".setup/meshes"));
    let of_user = dirs::data_dir().map(|folder| folder.join("rayscale/meshes"));
    set_up.chain(of_user).collect()
}

/// The path of a mesh by its file's name.
pub(crate) fn mesh(name: &str) -> Option<PathBuf> {
    let of_definitions = scenes().into_iter();
    of_definitions.chain(meshes()).map(|folder| folder.join(name)).find(|path| Path::is_file(path))
}
