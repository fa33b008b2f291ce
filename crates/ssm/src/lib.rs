//! Uniform subdivision of space with an inverted list of objects in each cell (SSM), the
//! method that BMSSM is compared with (Skala 1993, §5).
//!
//! - [`SsmList`] (`ssm-list`): a counter, a pointer and a list of ids for each cell, as
//!   the paper counts its memory.
//! - [`Ssm`] (`ssm`): the compact grid of A. Lagae and P. Dutré, *Compact, Fast and Robust Grids for Ray
//!   Tracing*, Eurographics Symposium on Rendering 2008: one index for each cell and one number for each
//!   reference, made fast by occupancy bits over bricks of cells and by objects packed in groups.
#![forbid(unsafe_code)]

mod compact;
mod list;
mod register;
mod resolution;
mod settings;

pub use compact::Ssm;
pub use list::SsmList;
pub use resolution::Resolution;
pub use settings::Settings;
