#![doc = include_str!("lib.md")]
#![forbid(unsafe_code)]

mod dense;
mod face;
mod fast;
mod general;
mod id;
mod raster;

pub use accel::{
    Aabb, AnyRays, BuildError, Footprint, Hit, InputError, Objects, Position, Ray, RayError, Surface, Vec3,
};
pub use face::{Bmssm, Camera, CameraError, Image, Options};
pub use lanes::Level as Simd;
pub use primitives::KernelId as Kernel;

/// The structures and their parts with every setting, as the suite that compares them takes them.
pub mod suite {
    /// The paper as it stands.
    pub mod dense {
        pub use crate::dense::*;
    }
    /// The fast structure for whatever a workload names.
    pub mod fast {
        pub use crate::fast::*;
    }
    /// The maps for rays of any kind.
    pub mod general {
        pub use crate::general::*;
    }
    /// The maps for one image.
    pub mod raster {
        pub use crate::raster::*;
    }
}
