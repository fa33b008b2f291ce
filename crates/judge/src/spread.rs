//! How far off answers are that are not wrong, or not altogether.

use serde::{Deserialize, Serialize};

/// The middle, the 99 % and the largest of many errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Half are no larger.
    pub median: f64,
    /// 99 % are no larger.
    pub p99: f64,
    /// None is larger.
    pub largest: f64,
}

impl Spread {
    /// Of these errors, which are put in another order for it; all 0 if there is none.
    pub fn of(errors: &mut [f64]) -> Self {
        Self { median: at(errors, 0.5), p99: at(errors, 0.99), largest: at(errors, 1.0) }
    }
}

/// The error of the nearest rank, so that every figure is one that occurred.
fn at(errors: &mut [f64], share: f64) -> f64 {
    if errors.is_empty() {
        return 0.0;
    }
    let rank = (share * errors.len() as f64).ceil() as usize;
    *errors.select_nth_unstable_by(rank.max(1) - 1, f64::total_cmp).1
}

/// Errors in space of hits of the right surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Hits whose place was compared.
    pub hits: u64,
    /// From the reported point, by the surface coordinates, to the true one, in extents of the scene.
    pub point: Spread,
    /// Along the ray, by t, in extents of the scene.
    pub along: Spread,
    /// Of t in units in the last place of `f32`, where the hit is farther from the ray's origin than the tolerance and t is a normal
    /// number: near 0 such units say nothing of places.
    pub t_ulps: Spread,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_errors_that_occurred() {
        let mut errors: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        assert_eq!(Spread::of(&mut errors), Spread { median: 100.0, p99: 198.0, largest: 200.0 });
        assert_eq!(Spread::of(&mut [7.0]), Spread { median: 7.0, p99: 7.0, largest: 7.0 });
        assert_eq!(Spread::of(&mut []), Spread::default());
    }
}
