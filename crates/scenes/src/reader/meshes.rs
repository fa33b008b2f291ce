//! Where the meshes that set-up fetches are kept.

use std::env;
use std::path::{Path, PathBuf};

/// Names the folder of meshes, if set.
const VARIABLE: &str = "RAYSCALE_MESHES";
const FOLDER: &str = ".setup/meshes";

/// The path of mesh file `name`, looked for in the folder that the environment variable
/// `RAYSCALE_MESHES` names, then in `.setup/meshes` of the checkout that this program was
/// built from, then of the current directory.
pub fn find(name: &str) -> Option<PathBuf> {
    if let Some(folder) = env::var_os(VARIABLE) {
        return Some(Path::new(&folder).join(name)).filter(|path| path.is_file());
    }
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = [checkout, PathBuf::from(".")];
    folders.into_iter().map(|folder| folder.join(FOLDER).join(name)).find(|path| path.is_file())
}
