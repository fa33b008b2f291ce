//! How large scenes are, where, and from how far away rays come.

use crate::Numbers;
use serde::{Deserialize, Serialize};

/// Where and how large a scene is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// Its size is about two to this.
    pub scale: i32,
    /// How far it is from the origin of coordinates: about two to this times its size; none for no offset.
    pub offset: Option<i32>,
    /// How far rays begin: about two to this times its size.
    pub origins: i32,
}

/// Largest exponents of [`Reach`], which a run has been through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Least and greatest scale.
    pub scale: [i32; 2],
    /// Greatest offset.
    pub offset: i32,
    /// Greatest distance of rays' origins.
    pub origins: i32,
}

/// A scene of size 1 about the origin of coordinates, and rays from near it.
pub const CLOSE: Reach = Reach { scale: 0, offset: None, origins: 1 };

/// What the marathon runs over.
pub const WIDE: Bounds = Bounds { scale: [-120, 120], offset: 24, origins: 99 };

impl Reach {
    /// One within these bounds; half of all are of usual size, near the origin of coordinates, with rays from near.
    pub fn new(numbers: &mut impl Numbers, within: &Bounds) -> Self {
        let up_to = |numbers: &mut dyn FnMut(u32) -> u32, most: i32| numbers(most.unsigned_abs() + 1) as i32;
        let mut below = |end: u32| numbers.below(end);
        let [least, most] = within.scale;
        let scale = if below(2) == 0 { 0 } else { least + up_to(&mut below, most - least) };
        let offset = (below(4) == 0).then(|| up_to(&mut below, within.offset));
        // Farther out there are no numbers.
        let farthest = within.origins.min(126 - scale - offset.unwrap_or(0)).max(1);
        let origins = if below(4) == 0 { up_to(&mut below, farthest) } else { 1 };
        Self { scale, offset, origins }
    }

    pub(super) fn size(&self) -> f32 {
        2f32.powi(self.scale)
    }
}
