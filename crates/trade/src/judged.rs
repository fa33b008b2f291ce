//! Answers judged by exact arithmetic, set by set.

use accel::{Accel, RaySet};
use harness::answers::Answers;
use harness::workload::{RayQuery, pick, sample};
use judge::{Bounds, Counts, Errors, Judge, Kind, Tally, Truth};
use scenes::rays::Query;
use serde::{Deserialize, Serialize};

/// A set of rays with the exact answers.
pub struct Set {
    /// Its name.
    pub name: String,
    /// What is asked of the rays.
    pub query: Query,
    /// The rays, as a list.
    pub rays: RaySet,
    /// The answers.
    pub truth: Truth,
}

impl Set {
    /// The rays of a set, decided; `heard` is told how many are.
    pub fn decide(judge: &Judge, asked: &RayQuery, heard: &mut dyn FnMut(usize)) -> Self {
        // A list even of an image: structures are judged as they are built for any rays.
        let rays = pick(&asked.rays, &(0..asked.rays.len()).collect::<Vec<_>>());
        let truth = judge.truth(&rays, heard);
        Self { name: asked.id.name().to_owned(), query: asked.query, rays, truth }
    }

    /// At most so many rays of it, spread evenly.
    pub fn fewer(&self, most: usize) -> Self {
        let numbers = sample(self.rays.len(), most);
        let truth = Truth(numbers.iter().map(|i| self.truth.0[*i]).collect());
        Self { name: self.name.clone(), query: self.query, rays: pick(&self.rays, &numbers), truth }
    }

    /// What a structure answers, judged.
    pub fn judge(&self, judge: &Judge, accel: &dyn Accel) -> Tally {
        let mut answers = Answers::new(self.query, self.rays.len());
        answers.trace(accel, &self.rays);
        match &answers {
            Answers::Closest(hits) => judge.judge_all(&self.rays, &self.truth, hits),
            Answers::Occluded(any) => {
                let mut tally = Tally::default();
                for (any, truth) in any.iter().zip(&self.truth.0) {
                    tally.counts.add(match (any, truth.is_some()) {
                        (false, true) => Some(Kind::Hole),
                        (true, false) => Some(Kind::Phantom),
                        _ => None,
                    });
                }
                tally
            }
        }
    }
}

/// What was found on a set, or on sets of one sort.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The set, or none for a sum.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub rays: String,
    /// Answers by kind.
    pub counts: Counts,
    /// The 95 % intervals of their shares.
    pub bounds: KindBounds,
    /// Errors in space.
    pub errors: Errors,
}

/// A 95 % interval for each kind, as shares of the rays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KindBounds {
    /// Of holes.
    pub holes: Bounds,
    /// Of phantoms.
    pub phantoms: Bounds,
    /// Of displaced hits.
    pub displaced: Bounds,
    /// Of swapped objects.
    pub swapped: Bounds,
    /// Of ties.
    pub ties: Bounds,
    /// Of holes, phantoms and displaced hits together.
    pub visible: Bounds,
}

impl Default for KindBounds {
    fn default() -> Self {
        Self::of(&Counts::default())
    }
}

impl KindBounds {
    fn of(counts: &Counts) -> Self {
        let of = |kind| counts.bounds(counts.of(kind));
        Self {
            holes: of(Kind::Hole),
            phantoms: of(Kind::Phantom),
            displaced: of(Kind::Displaced),
            swapped: of(Kind::Swapped),
            ties: of(Kind::Tie),
            visible: counts.bounds(counts.visible()),
        }
    }
}

impl Judged {
    /// The figures of a tally.
    pub fn of(rays: &str, mut tally: Tally) -> Self {
        let counts = tally.counts;
        Self { rays: rays.to_owned(), counts, bounds: KindBounds::of(&counts), errors: tally.errors() }
    }

    /// Counts alone, as records of old have them.
    pub fn counted(counts: Counts) -> Self {
        Self { counts, bounds: KindBounds::of(&counts), ..Self::default() }
    }

    /// Visible errors in a million rays.
    pub fn visible_per_million(&self) -> f64 {
        self.counts.per_million(self.counts.visible())
    }
}
