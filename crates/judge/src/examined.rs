//! What was found on rays that were looked at.

use crate::{Bounds, Counted, Counts, Kind};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::AddAssign;

/// Answers to some rays, which may stand for more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Examined {
    /// By kind.
    pub counts: Counts,
    /// Rays that those judged stand for: as many, or more of which they are a sample.
    pub of: u64,
    /// How far the farthest hit of the right surface is from its place along the ray, in extents of the scene.
    pub farthest: f64,
}

impl Examined {
    /// All rays were judged, and these are the answers.
    pub const fn all(counts: Counts, farthest: f64) -> Self {
        Self { counts, of: counts.rays, farthest }
    }

    /// A count in a million: as it is where every ray was judged, else the most that such a sample leaves likely.
    pub fn bound_per_million(&self, count: u64) -> f64 {
        if self.counts.rays == self.of {
            self.counts.per_million(count)
        } else {
            self.likely_per_million(count)
        }
    }

    /// A count in a million other rays of the same sort: the most that those judged leave likely (95 %).
    pub fn likely_per_million(&self, count: u64) -> f64 {
        Bounds::of(count, self.counts.rays).high * 1e6
    }

    /// In words: how many of the kinds that count, on how many rays.
    pub fn words(&self, counted: Counted) -> String {
        let kinds: Vec<String> = Kind::ALL
            .iter()
            .filter(|kind| {
                Kind::VISIBLE.contains(kind) || (counted == Counted::Identity && **kind == Kind::Swapped)
            })
            .map(|kind| format!("{} {}", self.counts.of(*kind), kind.plural()))
            .collect();
        let rays = grouped(self.counts.rays);
        if self.counts.rays == self.of {
            return format!("{} on all {rays} rays", kinds.join(", "));
        }
        let bound = self.bound_per_million(self.counts.errors(counted));
        format!("{} on a sample of {rays} rays, {bound:.3} in a million at most", kinds.join(", "))
    }
}

impl AddAssign for Examined {
    fn add_assign(&mut self, other: Self) {
        self.counts += other.counts;
        self.of += other.of;
        self.farthest = self.farthest.max(other.farthest);
    }
}

impl fmt::Display for Examined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(Counted::Visible))
    }
}

/// `66,450`
fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_without_errors_leaves_three_likely() {
        let rays = 1_000_000;
        let none = Examined { counts: Counts { rays, ..Counts::default() }, of: 2_000_000, farthest: 0.0 };
        assert_eq!(none.bound_per_million(0), 3.0);
        assert_eq!(Examined { of: rays, ..none }.bound_per_million(0), 0.0);
        let hundred = none.bound_per_million(100);
        assert!((115.0..125.0).contains(&hundred), "{hundred}");
        assert_eq!(
            none.to_string(),
            "0 holes, 0 phantoms, 0 displaced on a sample of 1,000,000 rays, 3.000 in a million at most"
        );
    }
}
