//! Haines' Standard Procedural Databases (E. Haines 1987, "A Proposal for Standard Graphics
//! Environments", IEEE CG&A 7(11); definitions at
//! <https://github.com/erich666/StandardProceduralDatabases>), and the teapot.
//!
//! Each function returns the scene's primitives in the published number; tessellation comes
//! after. The names of the parameters are those of the databases: a size factor `sf`.

mod balls;
mod gears;
mod jacks;
mod lattice;
mod mount;
mod rings;
mod shells;
mod sombrero;
mod teapot;
mod tetra;
mod tree;

pub use balls::balls;
pub use gears::gears;
pub use jacks::jacks;
pub use lattice::lattice;
pub use mount::mount;
pub use rings::rings;
pub use shells::shells;
pub use sombrero::sombrero;
pub use teapot::{checkerboard, teapot};
pub use tetra::tetra;
pub use tree::tree;
