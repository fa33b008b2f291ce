//! Embree 4 behind `accel::Accel`.
//!
//! The foreign functions are declared in `embree4-sys` and used in [`device`], [`scene`] and [`wrapper`] alone;
//! everything these offer is safe. [`wrapper`] goes through the crate `embree4-rs`, to measure what that costs.
//! `docs/embree.md` tells what to know of Embree from Rust.

pub mod denormals;
pub mod device;
pub mod one_thread;
pub mod packet;
pub mod scene;
mod solids;
mod structure;
pub mod wrapper;

pub use denormals::Denormals;
pub use device::{Device, EmbreeError, Isa, MemoryUse, version};
pub use one_thread::keep_to_one_thread;
pub use scene::{Coherence, EmbreeScene, Quality, SceneSettings};
pub use solids::SolidKinds;
pub use structure::{EmbreeBuilder, PacketFlag, Variant};
pub use wrapper::WrapperBuilder;
