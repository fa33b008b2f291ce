//! Ray-object tests: triangles with a choice of ray–triangle intersectors ([`Kernel`]), and boxes.

#![forbid(unsafe_code)]

mod boxes;
pub mod kernel;
mod objects;
mod triangles;

pub use boxes::Boxes;
pub use kernel::{Kernel, KernelId, WithKernel};
pub use objects::{WithObjects, with_objects};
pub use triangles::{TriangleBlocks, Triangles};
