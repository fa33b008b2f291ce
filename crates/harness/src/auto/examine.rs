//! Errors of kernels on a scene's rays.

use crate::answers::Answers;
use crate::check::{judge, oracle_of};
use crate::record::Query;
use crate::registry;
use crate::units;
use crate::workload::{Batch, pick, sample};
use accel::{Accel, RaySet, Scene};
use oracle::Oracle;
use primitives::KernelId;
use std::fmt;

/// Wrong answers among rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wrong {
    /// Rays examined.
    pub rays: u64,
    /// Rays that they stand for: as many, or more of which they are a sample.
    pub of: u64,
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub false_hits: u64,
    /// A hit of another object than the nearest.
    pub wrong_object: u64,
}

impl Wrong {
    /// Wrong answers of any kind.
    pub fn total(&self) -> u64 {
        self.missed + self.false_hits + self.wrong_object
    }

    /// Wrong answers in a million of the rays examined.
    pub fn per_million(&self) -> f64 {
        self.total() as f64 * 1e6 / self.rays.max(1) as f64
    }

    /// Wrong answers in a million: as they are where every ray was examined, else the most that
    /// such a sample leaves likely.
    pub fn bound_per_million(&self) -> f64 {
        if self.rays == self.of { self.per_million() } else { self.likely_per_million() }
    }

    /// Wrong answers in a million of other rays of the same kind: the most that those examined leave likely (95 %, rare
    /// events; Wilson and Hilferty's approximation).
    pub fn likely_per_million(&self) -> f64 {
        let k = self.total() as f64 + 1.0;
        let most = k * (1.0 - 1.0 / (9.0 * k) + 1.645 / (3.0 * k.sqrt())).powi(3);
        most * 1e6 / self.rays.max(1) as f64
    }

    fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.of += other.of;
        self.missed += other.missed;
        self.false_hits += other.false_hits;
        self.wrong_object += other.wrong_object;
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (total, rays) = (units::count(self.total()), units::count(self.rays));
        if self.rays == self.of {
            return write!(f, "{total} wrong on all {rays} rays");
        }
        write!(
            f,
            "{total} wrong on a sample of {rays} rays, {:.3} in a million at most",
            self.bound_per_million()
        )
    }
}

/// The exact answers to some rays of a set.
struct Known {
    rays: RaySet,
    of: u64,
    answers: Answers,
}

/// Examines kernels on the rays of a scene of triangles.
///
/// The exact kernel says which answers are right; every nearest hit on which another kernel
/// or a foreign structure differs is judged by the oracle besides.
pub struct Examiner<'s> {
    scene: &'s Scene,
    known: Vec<Known>,
    oracle: Option<Oracle>,
}

impl<'s> Examiner<'s> {
    /// Looks at no more than `most` rays of all batches together, spread evenly.
    pub fn new(scene: &'s Scene, batches: &[Batch], most: usize) -> Self {
        let exact = registry::quick(scene, KernelId::Exact);
        let share = most / batches.len().max(1);
        let know = |batch: &Batch| {
            let numbers = sample(batch.rays.len(), share);
            let rays = pick(batch.rays, &numbers);
            let mut answers = Answers::new(batch.query, rays.len());
            answers.trace(exact.as_ref(), &rays);
            Known { rays, of: batch.rays.len() as u64, answers }
        };
        Self { scene, known: batches.iter().map(know).collect(), oracle: None }
    }

    /// A kernel's errors for each batch.
    pub fn examine(&mut self, kernel: KernelId) -> Vec<Wrong> {
        let accel = registry::quick(self.scene, kernel);
        self.examine_structure(accel.as_ref())
    }

    /// A structure's errors for each batch.
    pub fn examine_structure(&mut self, accel: &dyn Accel) -> Vec<Wrong> {
        (0..self.known.len()).map(|i| self.one(i, accel)).collect()
    }

    /// A kernel's errors over all batches.
    pub fn examine_all(&mut self, kernel: KernelId) -> Wrong {
        let mut sum = Wrong::default();
        self.examine(kernel).iter().for_each(|wrong| sum.add(wrong));
        sum
    }

    fn one(&mut self, i: usize, accel: &dyn Accel) -> Wrong {
        let Known { rays, of, answers } = &self.known[i];
        let mut wrong = Wrong { rays: rays.len() as u64, of: *of, ..Wrong::default() };
        match answers {
            Answers::Closest(exact) => {
                let mut hits = vec![None; rays.len()];
                accel.trace(rays, &mut hits);
                let object = |hit: &Option<accel::Hit>| hit.map(|hit| hit.object);
                let differ = |i: &usize| object(&hits[*i]) != object(&exact[*i]);
                let numbers: Vec<usize> = (0..rays.len()).filter(differ).collect();
                if !numbers.is_empty() {
                    let oracle = self.oracle.get_or_insert_with(|| oracle_of(self.scene));
                    let errors = judge(oracle, rays, &hits, &numbers);
                    wrong.missed = errors.missed;
                    wrong.false_hits = errors.false_hits;
                    wrong.wrong_object = errors.wrong_object;
                }
            }
            Answers::Occluded(exact) => {
                let mut found = Answers::new(Query::Occluded, rays.len());
                found.trace(accel, rays);
                if let Answers::Occluded(found) = &found {
                    for pair in found.iter().zip(exact) {
                        wrong.missed += u64::from(pair == (&false, &true));
                        wrong.false_hits += u64::from(pair == (&true, &false));
                    }
                }
            }
        }
        wrong
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_without_errors_leaves_three_likely() {
        let none = Wrong { rays: 1_000_000, of: 2_000_000, ..Wrong::default() };
        assert!((2.9..3.1).contains(&none.bound_per_million()), "{}", none.bound_per_million());
        let all = Wrong { of: 1_000_000, ..none };
        assert_eq!(all.bound_per_million(), 0.0);
        let some = Wrong { missed: 60, false_hits: 20, wrong_object: 20, ..none };
        assert!((115.0..120.0).contains(&some.bound_per_million()), "{}", some.bound_per_million());
        assert_eq!(some.per_million(), 100.0);
    }

    /// At corners of a distant sphere Möller and Trumbore's test is often wrong, and the exact one never.
    #[test]
    fn errors_are_found_and_judged() {
        use scenes::rays::{RaysId, RaysSpec, generate};
        let scene = scenes::load(&"bumps-1k@offset=1e5,0,0".parse().unwrap()).unwrap();
        let tracer = registry::quick(&scene, KernelId::Exact);
        let spec = RaysSpec { id: RaysId::LeakVertex, rows: 40, cols: 40, seed: 1 };
        let rays = generate(&scene, &spec, tracer.as_ref()).unwrap();
        let batch = |query| Batch { rays: &rays, query };
        let mut examiner = Examiner::new(&scene, &[batch(Query::Closest), batch(Query::Occluded)], 1000);
        let rough = examiner.examine(KernelId::MollerTrumbore);
        assert!(rough[0].total() > 0 && rough[0].rays == 500 && rough[0].of == 1600, "{rough:?}");
        assert!(rough[1].missed > 0 && rough[1].missed <= rough[0].missed, "{rough:?}");
        assert_eq!(examiner.examine_all(KernelId::Exact).total(), 0);
        assert_eq!(examiner.examine_all(KernelId::Watertight).missed, 0);
    }
}
