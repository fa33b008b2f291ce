//! The contract that ray-tracing acceleration structures are compared under: rays, hits,
//! objects, scenes, ray-object kernels, grid arithmetic, memory footprints, brute force, and an
//! oracle that rounds nothing.
//!
//! Every structure stands behind [`Accel`] and is made by a [`Builder`] from a [`Scene`] and
//! a [`Need`]. What a structure knows of the scene is [`Objects`].

mod aabb;
pub mod baseline;
pub mod dda;
pub mod exact;
mod footprint;
pub mod grid;
pub mod kernel;
mod memory;
pub mod morton;
pub mod objects;
pub mod packet;
mod ray;
mod rayset;
mod scene;
pub mod settings;
pub mod simd;
mod structure;

pub use aabb::Aabb;
pub use footprint::{Footprint, Group, Part, vec_bytes};
pub use glam::Vec3;
pub use kernel::{Kernel, KernelId};
pub use memory::{available_memory, concatenated, filled};
pub use objects::{Blocks, Objects};
pub use ray::{Hit, Nearest, Ray, RayError, Surface};
pub use rayset::{Projection, Raster, RaySet};
pub use scene::{Geometry, Mesh, Scene, View, WithObjects};
pub use structure::{Accel, BuildError, Builder, Count, Counters, Need, NoCount, for_each_ray};
