//! The nearest thing that a ray meets among triangles, or objects of any kind, by a uniform grid: space subdivision (SSM), the
//! method that BMSSM is compared with (Skala 1993, §5).
//!
//! ```
//! use ssm::{Ray, Ssm, Vec3};
//!
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let triangles = [[0, 1, 2]];
//! let ssm = Ssm::build(&positions, &triangles)?;
//! let hit = ssm.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z)).unwrap();
//! assert_eq!((hit.object, hit.t), (0, 1.0));
//! # Ok::<(), ssm::BuildError>(())
//! ```
//!
//! [`Ssm`] is the compact grid of A. Lagae and P. Dutré, *Compact, Fast and Robust Grids for Ray Tracing*,
//! Eurographics Symposium on Rendering 2008: one index for each cell and one number for each reference, made fast by
//! occupancy bits over bricks of cells and by objects packed in groups. [`Options`] has the ray-triangle intersector,
//! the number of cells, the instruction set and the limit of memory; [`Objects`] is what objects of other kinds than
//! triangles tell. [`suite::SsmList`] is the grid of the paper: a counter, a pointer and a list of ids for each cell, as it counts
//! its memory.
//!
//! # Features
//! - `parallel` (default): building and tracing use all threads of the current rayon pool.
//! - `exact` (default): the ray-triangle intersector `Kernel::Exact`, whose every decision is the true one. Without it
//!   the crate compiles sooner.
#![forbid(unsafe_code)]

mod compact;
mod face;
mod list;
mod once;
mod register;
mod resolution;
mod settings;

pub use accel::{
    Aabb, AnyRays, BuildError, Footprint, Hit, InputError, Objects, Position, Ray, RayError, Surface, Vec3,
};
pub use face::{Options, Ssm};
pub use lanes::Level as Simd;
pub use primitives::KernelId as Kernel;

/// The structures with every setting, as the suite that compares them takes them.
pub mod suite {
    pub use crate::compact::Ssm;
    pub use crate::list::SsmList;
    pub use crate::resolution::Resolution;
    pub use crate::settings::Settings;
}
