//! Where the meshes that set-up fetches are kept.

use crate::folders;
use std::path::PathBuf;

/// The path of mesh file `name`, if it is on this machine; see [`folders::Folders`].
pub fn find(name: &str) -> Option<PathBuf> {
    folders::mesh(name)
}
