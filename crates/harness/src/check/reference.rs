//! Brute force as the reference, on as many rays as there is time for.

use crate::answers::Answers;
use crate::record::Query;
use crate::workload::{pick, sample};
use accel::{Accel, Builder, RaySet, Scene, Workload};
use baselines::Brute;
use primitives::KernelId;

/// Right answers for some rays of a set.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The numbers of those rays in the set, ascending.
    pub numbers: Vec<usize>,
    /// What brute force answers to them.
    pub answers: Answers,
}

impl Reference {
    /// Brute force by `kernel` over at most `tests` ray-object tests, one ray at least, on all threads of
    /// the current pool. Fewer rays than the set has are a sample of it.
    pub fn new(scene: &Scene, rays: &RaySet, query: Query, kernel: KernelId, tests: u64) -> Self {
        let brute =
            Brute::new(kernel).build(scene, &Workload::GENERAL).expect("brute force serves every scene");
        Self::by(brute.as_ref(), scene.geometry.len(), rays, query, tests)
    }

    /// As [`Reference::new`] with brute force built already.
    pub fn by(brute: &dyn Accel, objects: usize, rays: &RaySet, query: Query, tests: u64) -> Self {
        let most = (tests / objects.max(1) as u64).max(1);
        let numbers = sample(rays.len(), usize::try_from(most).unwrap_or(usize::MAX));
        let mut answers = Answers::new(query, numbers.len());
        answers.trace(brute, &pick(rays, &numbers));
        Self { numbers, answers }
    }
}

/// Numbers of the rays whose `answers` (to the whole set) are not the reference's, bit for bit.
///
/// # Panics
/// If there are fewer answers than the reference names.
pub fn compare(answers: &Answers, reference: &Reference) -> Vec<usize> {
    let places = reference.numbers.iter().enumerate();
    places.filter(|(j, i)| !answers.same(**i, &reference.answers, *j)).map(|(_, i)| *i).collect()
}
