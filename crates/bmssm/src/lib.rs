//! The nearest thing that a ray meets among triangles, or objects of any kind, by bit maps: the *Binary Map of Space
//! Subdivision Method* (V. Skala, *Memory saving technique for space subdivision technique*, Machine GRAPHICS and
//! VISION 2(3), 1993), made fast by SIMD and by maps in two levels.
//!
//! ```
//! use bmssm::{Bmssm, Ray, Vec3};
//!
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let triangles = [[0, 1, 2]];
//! let bmssm = Bmssm::build(&positions, &triangles)?;
//! let hit = bmssm.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z)).unwrap();
//! assert_eq!((hit.object, hit.t), (0, 1.0));
//! # Ok::<(), bmssm::BuildError>(())
//! ```
//!
//! - [`Bmssm`] traces any rays: the nearest hit ([`AnyRays::closest`]) or whether there is one
//!   ([`AnyRays::occluded`]), one by one or many at once ([`AnyRays::trace`]).
//! - [`Image`] serves the pixels of one [`Camera`] and nothing else: it is built sooner, takes less memory and
//!   traces faster than the other.
//! - [`Objects`] is what objects of other kinds than triangles tell: their boxes, and where a ray meets one.
//! - [`Options`] has the ray-triangle intersector, the instruction set and the limit of memory.
//!
//! Whatever the instruction set and the number of threads, the hits are the same to the bit: those of the chosen
//! intersector on every triangle, the nearest first, of equally near ones the one of lowest number.
//!
//! # Features
//! - `parallel` (default): building and tracing use all threads of the current rayon pool.
//! - `exact` (default): the ray-triangle intersector `Kernel::Exact`, whose every decision is the true one. Without it
//!   the crate compiles sooner.
//!
//! # Pixels
//! ```
//! use bmssm::{Bmssm, Camera};
//!
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let camera = Camera::perspective([0.3, 0.3, 3.0], [0.3, 0.3, 0.0], [0.0, 1.0, 0.0], 45.0, [48, 64]).unwrap();
//! let image = Bmssm::for_image(&camera, &positions, &[[0, 1, 2]])?;
//! let shown = image.trace().iter().flatten().count();
//! assert!(shown > 0 && image.closest(24, 32).is_some());
//! # Ok::<(), bmssm::BuildError>(())
//! ```
//!
//! # Objects of other kinds
//! ```
//! use bmssm::{Aabb, Bmssm, Objects, Ray, Surface, Vec3};
//!
//! struct Balls(Vec<(Vec3, f32)>);
//!
//! impl Objects for Balls {
//!     fn len(&self) -> usize {
//!         self.0.len()
//!     }
//!     fn bounds(&self, id: u32) -> Aabb {
//!         let (center, radius) = self.0[id as usize];
//!         Aabb { min: center - radius, max: center + radius }
//!     }
//!     fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
//!         let (center, radius) = self.0[id as usize];
//!         let (to, d) = (center - ray.origin, ray.direction);
//!         let (a, half_b) = (d.length_squared(), to.dot(d));
//!         let root = (half_b * half_b - a * (to.length_squared() - radius * radius)).sqrt();
//!         let t = [(half_b - root) / a, (half_b + root) / a].into_iter().find(|t| *t >= ray.t_min)?;
//!         (t <= t_max).then_some(Surface { t, u: 0.0, v: 0.0 })
//!     }
//! }
//!
//! let balls = Balls(vec![(Vec3::ZERO, 1.0), (Vec3::splat(3.0), 0.5)]);
//! let bmssm = Bmssm::build_objects(&balls)?;
//! let hit = bmssm.closest(&Ray::new(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z)).unwrap();
//! assert_eq!((hit.object, hit.t), (0, 4.0));
//! # Ok::<(), bmssm::BuildError>(())
//! ```
#![forbid(unsafe_code)]

mod dense;
mod face;
mod fast;
mod general;
mod image_space;
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
