//! Embree 4 behind `accel::Accel`.
//!
//! The foreign functions are declared in [`sys`] and used in [`device`], [`scene`] and [`denormals`]
//! alone; everything these offer is safe unless it says otherwise.

pub mod denormals;
pub mod device;
pub mod one_thread;
pub mod rayhit;
pub mod scene;
mod structure;
pub mod sys;

pub use denormals::Denormals;
pub use device::{Device, EmbreeError, MemoryUse, version};
pub use one_thread::keep_to_one_thread;
pub use scene::{EmbreeScene, Quality, SceneSettings};
pub use structure::{EmbreeBuilder, Variant};
