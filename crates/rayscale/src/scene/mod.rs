//! Scenes: definitions, generators, loaders, export.
//!
//! ```
//! use rayscale::scene::{load, SceneSpec};
//!
//! let spec: SceneSpec = "bumps-2k@scale=-10".parse()?;
//! let scene = load(&spec)?;
//! assert_eq!(scene.id, "bumps-2k@scale=-10");
//! # Ok::<(), rayscale::scene::SceneError>(())
//! ```

mod catalog;
mod checksum;
mod definition;
mod error;
mod export;
pub mod generate;
mod modifier;
mod reader;
mod resolve;
mod spec;
mod split;
#[cfg(test)]
mod tests;
mod view;

pub use catalog::{SceneInfo, describe, list};
pub use checksum::checksum;
pub use error::SceneError;
pub use export::{export_obj, write_obj};
pub use modifier::{Modifiers, Transform};
pub use reader::{file_sha256, mesh as load_mesh};
pub use resolve::{Loaded, load, load_full};
pub use spec::{SceneSpec, Source};
pub use split::{Split, split};
pub use view::framing;
