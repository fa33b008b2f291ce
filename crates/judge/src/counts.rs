//! How many answers are wrong, and how.

use crate::{Bounds, Kind};
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Answers to some rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Rays judged.
    pub rays: u64,
    /// [`Kind::Hole`].
    pub holes: u64,
    /// [`Kind::Phantom`].
    pub phantoms: u64,
    /// [`Kind::Displaced`].
    pub displaced: u64,
    /// [`Kind::Swapped`].
    pub swapped: u64,
    /// [`Kind::Tie`].
    pub ties: u64,
}

/// Which kinds count as errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Counted {
    /// Holes, phantoms and displaced hits: what shows in a picture.
    #[default]
    Visible,
    /// Swapped objects too, for those to whom it matters which object is hit.
    Identity,
}

impl Counted {
    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Visible => "holes, phantoms or displaced",
            Self::Identity => "holes, phantoms, displaced or of another object",
        }
    }
}

impl Counts {
    /// How many there are of a kind.
    pub const fn of(&self, kind: Kind) -> u64 {
        match kind {
            Kind::Hole => self.holes,
            Kind::Phantom => self.phantoms,
            Kind::Displaced => self.displaced,
            Kind::Swapped => self.swapped,
            Kind::Tie => self.ties,
        }
    }

    /// Counts a ray with its kind of error, if there is one.
    pub fn add(&mut self, kind: Option<Kind>) {
        self.rays += 1;
        let Some(kind) = kind else { return };
        *match kind {
            Kind::Hole => &mut self.holes,
            Kind::Phantom => &mut self.phantoms,
            Kind::Displaced => &mut self.displaced,
            Kind::Swapped => &mut self.swapped,
            Kind::Tie => &mut self.ties,
        } += 1;
    }

    /// Errors that show in a picture.
    pub const fn visible(&self) -> u64 {
        self.holes + self.phantoms + self.displaced
    }

    /// Errors of the kinds that count.
    pub const fn errors(&self, counted: Counted) -> u64 {
        match counted {
            Counted::Visible => self.visible(),
            Counted::Identity => self.visible() + self.swapped,
        }
    }

    /// So many in a million of these rays.
    pub fn per_million(&self, count: u64) -> f64 {
        count as f64 * 1e6 / self.rays.max(1) as f64
    }

    /// The 95 % interval of the share of a count.
    pub fn bounds(&self, count: u64) -> Bounds {
        Bounds::of(count, self.rays)
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        let Self { rays, holes, phantoms, displaced, swapped, ties } = other;
        self.rays += rays;
        self.holes += holes;
        self.phantoms += phantoms;
        self.displaced += displaced;
        self.swapped += swapped;
        self.ties += ties;
    }
}
