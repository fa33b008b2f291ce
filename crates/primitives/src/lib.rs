//! Ray-object tests: triangles with a choice of ray–triangle intersectors ([`Kernel`]), and boxes.

#![forbid(unsafe_code)]

mod boxes;
mod guarded;
pub mod kernel;
mod objects;
mod triangles;
mod with_kernel;

pub use boxes::Boxes;
pub use guarded::Guarded;
pub use kernel::{Kernel, KernelId};
pub use objects::{WithObjects, with_objects, with_triangles};
pub use triangles::{TriangleBlocks, TriangleKernel, Triangles};
pub use with_kernel::WithKernel;
