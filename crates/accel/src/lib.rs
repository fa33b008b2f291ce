//! The contract that ray-tracing acceleration structures are compared under: rays, hits,
//! objects, scenes, grid arithmetic, tolerances and memory footprints.
//!
//! Every structure stands behind [`Accel`] and is made by a [`Builder`] from a [`Scene`] and
//! a [`Workload`]. What a structure knows of the scene is [`Objects`].

#![forbid(unsafe_code)]

mod aabb;
pub mod all_hits;
mod any_rays;
mod camera;
mod cancel;
mod corners;
pub mod dda;
pub mod expansion;
pub mod far;
mod footprint;
pub mod grid;
pub mod image_space;
pub mod input;
pub mod keys;
mod memory;
mod mesh;
pub mod morton;
mod objects;
pub mod parallel;
pub mod parity;
mod ray;
mod rayset;
mod scene;
pub mod settings;
pub mod solid;
mod structure;
#[cfg(feature = "testing")]
pub mod testing;
pub mod tolerance;

pub use aabb::Aabb;
pub use any_rays::AnyRays;
pub use cancel::Cancel;
pub use corners::Corners;
pub use footprint::{Footprint, Group, Part, vec_bytes};
pub use glam::Vec3;
pub use input::{InputError, Position};
pub use memory::{append, available_memory, concatenated, filled, make_room, reserved, zeroed};
pub use mesh::{Mesh, MeshRef};
pub use objects::{Bounds, Objects};
pub use ray::{Hit, Nearest, Ray, RayError, Surface};
pub use rayset::{Common, Projection, Raster, RaySet};
pub use scene::{Geometry, Scene, View};
pub use solid::Solid;
pub use structure::{
    Accel, BuildError, BuildResult, Builder, Count, Counters, NoCount, Workload, for_each_ray,
};
