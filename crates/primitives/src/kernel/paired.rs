//! The capability of testing rays and triangles in pairs.

use super::{Kernel, Many};
use lanes::Simd;
use lanes::packet::{Lanes, Vec3Lanes};

/// A kernel whose prepared rays can change lanes.
pub trait Permuted: Kernel {
    /// The rays in the lanes whose numbers `at` holds.
    fn permuted<S: Simd>(s: S, rays: &Many<Self, S>, at: S::U) -> Many<Self, S>;
}

/// A kernel that takes a ray and a triangle in each lane. It packs the nine rows of corners as they are.
pub trait Paired: Permuted {
    /// Each ray against the triangle in its own lane, given by its corners, with the bits of [`Kernel::rays`].
    fn each<S: Simd>(s: S, rays: &Many<Self, S>, corners: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S>;
}

/// Every test is decided at once, and many rays and triangles are tested in pairs: for kernels that are [`Paired`].
#[derive(Clone, Copy, Debug)]
pub struct InPairs;
