//! What a structure answers to a set of rays.

use crate::record::Query;
use accel::{Accel, Hit, RaySet};
use std::hash::{DefaultHasher, Hash, Hasher};

/// One answer for each ray of a set.
#[derive(Clone, Debug, PartialEq)]
pub enum Answers {
    /// Nearest hits.
    Closest(Vec<Option<Hit>>),
    /// Whether there is any hit.
    Occluded(Vec<bool>),
}

/// A hit that no structure reports, so that an answer that was never written is noticed.
const UNWRITTEN: Hit = Hit { t: f32::NAN, object: u32::MAX, u: f32::NAN, v: f32::NAN };

impl Answers {
    /// Room for `len` answers.
    pub fn new(query: Query, len: usize) -> Self {
        match query {
            Query::Closest => Self::Closest(vec![Some(UNWRITTEN); len]),
            Query::Occluded => Self::Occluded(vec![false; len]),
        }
    }

    /// Makes all answers wrong: hits that don't exist, and the contrary of every truth value.
    pub fn poison(&mut self) {
        match self {
            Self::Closest(hits) => hits.fill(Some(UNWRITTEN)),
            Self::Occluded(any) => any.iter_mut().for_each(|any| *any = !*any),
        }
    }

    /// Has a structure answer all rays.
    ///
    /// # Panics
    /// If there are not as many rays as answers; whatever the structure panics with.
    pub fn trace(&mut self, accel: &dyn Accel, rays: &RaySet) {
        match self {
            Self::Closest(hits) => accel.trace(rays, hits),
            Self::Occluded(any) => accel.trace_occluded(rays, any),
        }
    }

    /// Number of answers.
    pub fn len(&self) -> usize {
        match self {
            Self::Closest(hits) => hits.len(),
            Self::Occluded(any) => any.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of rays that hit something.
    pub fn hits(&self) -> usize {
        match self {
            Self::Closest(hits) => hits.iter().flatten().count(),
            Self::Occluded(any) => any.iter().filter(|any| **any).count(),
        }
    }

    /// Whether answer `i` equals answer `j` of `other`, bit for bit. Answers to different queries
    /// never do.
    pub fn same(&self, i: usize, other: &Self, j: usize) -> bool {
        match (self, other) {
            (Self::Closest(a), Self::Closest(b)) => match (&a[i], &b[j]) {
                (Some(a), Some(b)) => a.same_bits(b),
                (None, None) => true,
                _ => false,
            },
            (Self::Occluded(a), Self::Occluded(b)) => a[i] == b[j],
            _ => false,
        }
    }

    /// The first answer that differs from `other`'s, if any; a difference in length counts.
    pub fn first_difference(&self, other: &Self) -> Option<usize> {
        let shared = self.len().min(other.len());
        let end = (self.len() != other.len()).then_some(shared);
        (0..shared).find(|i| !self.same(*i, other, *i)).or(end)
    }

    /// A number that other answers hardly ever share: a hash of every bit of them.
    pub fn fingerprint(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        match self {
            Self::Closest(hits) => {
                let bits = |hit: &Hit| (hit.t.to_bits(), hit.object, hit.u.to_bits(), hit.v.to_bits());
                hits.iter().for_each(|hit| hit.as_ref().map(bits).hash(&mut hasher));
            }
            Self::Occluded(any) => any.hash(&mut hasher),
        }
        hasher.finish()
    }

    /// The nearest hits, if that was the query.
    pub fn closest(&self) -> Option<&[Option<Hit>]> {
        match self {
            Self::Closest(hits) => Some(hits),
            Self::Occluded(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(t: f32, object: u32) -> Option<Hit> {
        Some(Hit { t, object, u: 0.25, v: 0.0 })
    }

    #[test]
    fn equality_is_of_bits() {
        let a = Answers::Closest(vec![hit(0.0, 1), None, hit(2.0, 3)]);
        assert_eq!(a.first_difference(&a.clone()), None);
        assert_eq!(a.fingerprint(), a.clone().fingerprint());
        for (i, other) in [
            (0, vec![hit(-0.0, 1), None, hit(2.0, 3)]),
            (1, vec![hit(0.0, 1), hit(1.0, 1), hit(2.0, 3)]),
            (2, vec![hit(0.0, 1), None, hit(2.0, 4)]),
            (2, vec![hit(0.0, 1), None, None]),
            (2, vec![hit(0.0, 1), None]),
        ] {
            let other = Answers::Closest(other);
            assert_eq!(a.first_difference(&other), Some(i));
            assert_ne!(a.fingerprint(), other.fingerprint());
        }
    }

    #[test]
    fn what_is_not_written_is_noticed() {
        for answers in [Answers::Closest(vec![None, hit(1.0, 2)]), Answers::Occluded(vec![true, false])] {
            let mut poisoned = answers.clone();
            poisoned.poison();
            assert!((0..2).all(|i| !poisoned.same(i, &answers, i)));
        }
    }
}
