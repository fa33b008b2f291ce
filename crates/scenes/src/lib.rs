//! Scenes and rays to compare structures by: definitions, generators, readers of meshes, ray
//! sets, and rays and hits as CSV.
//!
//! ```
//! use scenes::{load, SceneSpec};
//!
//! let spec: SceneSpec = "bumps-2k@scale=-10".parse()?;
//! let scene = load(&spec)?;
//! assert_eq!(scene.id, "bumps-2k@scale=-10");
//! # Ok::<(), scenes::SceneError>(())
//! ```

#![forbid(unsafe_code)]

mod analytic;
pub mod camera;
mod catalog;
mod checksum;
mod definition;
mod error;
pub mod exchange;
mod export;
mod folders;
pub mod generate;
mod modifier;
pub mod near;
mod random;
pub mod rays;
mod reader;
mod resolve;
mod rotation;
mod solid;
mod solids;
mod spec;
mod split;
#[cfg(test)]
mod tests;
mod view;

pub use catalog::{SceneInfo, broken_definitions, describe, list};
pub use checksum::checksum;
pub use definition::Definition;
pub use error::SceneError;
pub use export::write_obj;
pub use folders::{Folders, look_in};
pub use modifier::{Modifiers, Transform};
pub use random::Random;
pub use reader::{Polygons, file_sha256, mesh as load_mesh, mesh_of_bytes};
pub use resolve::{Loaded, load, load_full};
pub use spec::{SceneSpec, Source};
pub use split::{Split, split};
pub use view::{framing, upright};
