//! How many errors are put up with.

use crate::{Counted, Examined};
use serde::{Deserialize, Serialize};

/// What answers have to keep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Errors in a million rays, of the kinds that count.
    pub errors: Option<f64>,
    /// Holes in a million.
    pub holes: Option<f64>,
    /// How far a hit of the right surface may be from its place along the ray, in extents of the scene.
    pub displacement: Option<f64>,
    /// Which kinds `errors` counts.
    pub counted: Counted,
}

impl Default for Limits {
    /// One visible error in a million.
    fn default() -> Self {
        Self { errors: Some(1.0), ..Self::NONE }
    }
}

impl Limits {
    /// Anything goes.
    pub const NONE: Self = Self { errors: None, holes: None, displacement: None, counted: Counted::Visible };

    /// Whether any limit is set.
    pub const fn any(&self) -> bool {
        self.errors.is_some() || self.holes.is_some() || self.displacement.is_some()
    }

    /// Whether no error at all is put up with, which takes a proof.
    pub fn ask_for_none(&self) -> bool {
        self.errors.is_some_and(|limit| limit <= 0.0)
    }

    /// By which factor the answers exceed what they exceed most: 1 or less if they keep all limits.
    pub fn excess(&self, found: &Examined) -> f64 {
        let errors = found.bound_per_million(found.counts.errors(self.counted));
        let holes = found.bound_per_million(found.counts.holes);
        let over = |limit: Option<f64>, value: f64| match limit {
            None => 0.0,
            Some(limit) if value <= limit => 0.0,
            Some(limit) => (value / limit.max(1e-12)).max(1.0 + f64::EPSILON),
        };
        over(self.errors, errors)
            .max(over(self.holes, holes))
            .max(over(self.displacement, found.farthest))
            .max(1.0)
    }

    /// Whether the answers keep all limits.
    pub fn kept_by(&self, found: &Examined) -> bool {
        self.excess(found) <= 1.0
    }

    /// In words.
    pub fn words(&self) -> String {
        let mut all = Vec::new();
        all.extend(self.errors.map(|limit| format!("{limit} rays in a million {}", self.counted.words())));
        all.extend(self.holes.map(|limit| format!("{limit} holes in a million")));
        all.extend(self.displacement.map(|limit| format!("{limit} of the extent off")));
        if all.is_empty() { "no limit".to_owned() } else { format!("at most {}", all.join(", ")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Counts;

    #[test]
    fn each_limit_is_kept_for_itself() {
        let counts = Counts { rays: 1_000_000, holes: 2, phantoms: 3, swapped: 500, ..Counts::default() };
        let found = Examined::all(counts, 1e-6);
        let errors = |errors: f64| Limits { errors: Some(errors), ..Limits::NONE };
        assert!(Limits::NONE.kept_by(&found) && errors(5.0).kept_by(&found) && !errors(4.0).kept_by(&found));
        let identity = Limits { counted: Counted::Identity, ..errors(400.0) };
        assert!(!identity.kept_by(&found) && errors(400.0).kept_by(&found));
        assert_eq!(identity.excess(&found), 505.0 / 400.0);
        assert!(Limits { holes: Some(2.0), ..Limits::NONE }.kept_by(&found));
        assert!(!Limits { holes: Some(1.0), ..errors(1e6) }.kept_by(&found));
        assert!(!Limits { displacement: Some(1e-7), ..Limits::NONE }.kept_by(&found));
        assert!(
            Limits { errors: Some(0.0), ..Limits::NONE }.ask_for_none() && !Limits::default().ask_for_none()
        );
    }
}
