//! How far off a hit may be before it shows.

use serde::{Deserialize, Serialize};

/// A distance as a fraction of the scene's extent: the longest side of its bounds.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tolerance(f64);

impl Tolerance {
    /// A hundred-thousandth of the extent: a pixel is 2 to 50 times as wide in an image of a whole scene with a thousand
    /// rows.
    pub const VISIBLE: Self = Self(1e-5);

    /// That fraction; `None` unless it is finite and not negative.
    pub fn new(fraction: f64) -> Option<Self> {
        (fraction.is_finite() && fraction >= 0.0).then_some(Self(fraction))
    }

    /// The fraction.
    pub const fn fraction(self) -> f64 {
        self.0
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::VISIBLE
    }
}
