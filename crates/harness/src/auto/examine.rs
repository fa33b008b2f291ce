//! Errors of kernels on a scene's rays.

use crate::answers::Answers;
use crate::record::Query;
use crate::registry;
use crate::workload::{Batch, pick, sample};
use accel::{Accel, Hit, RaySet, Scene};
use judge::{Examined, Judge, Tolerance, TrueHit};
use primitives::KernelId;
use rayon::prelude::*;

/// The exact answers to some rays of a set.
struct Known {
    rays: RaySet,
    of: u64,
    answers: Answers,
}

/// Examines kernels on the rays of a scene of triangles.
///
/// The exact kernel says which answers are right; every nearest hit on which another kernel
/// or an external structure differs in more than the last digits of t is judged by the oracle besides.
pub struct Examiner<'s> {
    scene: &'s Scene,
    tolerance: Tolerance,
    extent: f64,
    known: Vec<Known>,
    judge: Option<Judge<'s>>,
    kernels: Vec<(KernelId, Vec<Examined>)>,
}

impl<'s> Examiner<'s> {
    /// Looks at no more than `most` rays of all batches together, spread evenly.
    pub fn new(scene: &'s Scene, batches: &[Batch], most: usize, tolerance: Tolerance) -> Self {
        let exact = registry::quick(scene, KernelId::Exact);
        let share = most / batches.len().max(1);
        let know = |batch: &Batch| {
            let numbers = sample(batch.rays.len(), share);
            let rays = pick(batch.rays, &numbers);
            let mut answers = Answers::new(batch.query, rays.len());
            answers.trace(exact.as_ref(), &rays);
            Known { rays, of: batch.rays.len() as u64, answers }
        };
        let bounds = scene.geometry.bounds();
        let extent = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max_element().max(0.0);
        let known = batches.iter().map(know).collect();
        Self { scene, tolerance, extent, known, judge: None, kernels: Vec::new() }
    }

    /// A kernel's errors for each batch.
    pub fn examine(&mut self, kernel: KernelId) -> Vec<Examined> {
        if let Some((_, found)) = self.kernels.iter().find(|(known, _)| *known == kernel) {
            return found.clone();
        }
        let accel = registry::quick(self.scene, kernel);
        let found = self.examine_structure(accel.as_ref());
        self.kernels.push((kernel, found.clone()));
        found
    }

    /// A structure's errors for each batch.
    pub fn examine_structure(&mut self, accel: &dyn Accel) -> Vec<Examined> {
        (0..self.known.len()).map(|i| self.one(i, accel)).collect()
    }

    /// A kernel's errors over all batches.
    pub fn examine_all(&mut self, kernel: KernelId) -> Examined {
        let mut sum = Examined::default();
        self.examine(kernel).iter().for_each(|found| sum += *found);
        sum
    }

    fn one(&mut self, i: usize, accel: &dyn Accel) -> Examined {
        let Known { rays, of, answers } = &self.known[i];
        let mut found = Examined { of: *of, ..Examined::default() };
        found.counts.rays = rays.len() as u64;
        match answers {
            Answers::Closest(exact) => {
                let mut hits = vec![None; rays.len()];
                accel.trace(rays, &mut hits);
                let unit = if self.extent > 0.0 { self.extent } else { 1.0 };
                let mut suspects = Vec::new();
                for (i, (hit, exact)) in hits.iter().zip(exact).enumerate() {
                    match off(&rays.ray(i), *hit, *exact) {
                        // Half the tolerance, for t of the exact kernel is rounded too.
                        Some(off) if off <= 0.5 * self.tolerance.fraction() * self.extent => {
                            found.farthest = found.farthest.max(off / unit);
                        }
                        _ => suspects.push(i),
                    }
                }
                suspects.retain(|i| hits[*i].is_some() || exact[*i].is_some());
                if !suspects.is_empty() {
                    let judge = self.judge.get_or_insert_with(|| Judge::new(self.scene, self.tolerance));
                    let one = |i: &usize| {
                        let ray = rays.ray(*i);
                        let truth = judge.oracle().closest(&ray);
                        judge.judge(&ray, hits[*i], truth.as_ref().map(TrueHit::of).as_ref())
                    };
                    let judged: Vec<_> = suspects.par_iter().map(one).collect();
                    for judgement in judged {
                        found.counts.add(judgement.kind);
                        found.farthest = found.farthest.max(judgement.along.unwrap_or(0.0));
                    }
                    // They were counted among all rays already.
                    found.counts.rays = rays.len() as u64;
                }
            }
            Answers::Occluded(exact) => {
                let mut any = Answers::new(Query::Occluded, rays.len());
                any.trace(accel, rays);
                if let Answers::Occluded(any) = &any {
                    for pair in any.iter().zip(exact) {
                        found.counts.holes += u64::from(pair == (&false, &true));
                        found.counts.phantoms += u64::from(pair == (&true, &false));
                    }
                }
            }
        }
        found
    }
}

/// How far apart two hits of the same object are along the ray; `None` unless there are two.
fn off(ray: &accel::Ray, hit: Option<Hit>, exact: Option<Hit>) -> Option<f64> {
    let (hit, exact) = hit.zip(exact).filter(|(a, b)| a.object == b.object)?;
    Some((f64::from(hit.t) - f64::from(exact.t)).abs() * ray.direction.as_dvec3().length())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At corners of a distant sphere Möller and Trumbore's test is often wrong, and the exact one never.
    #[test]
    fn errors_are_found_and_judged() {
        let (scene, rays) = crate::testing::distant_corners();
        let batch = |query| Batch { rays: &rays, query };
        let batches = [batch(Query::Closest), batch(Query::Occluded)];
        let mut examiner = Examiner::new(&scene, &batches, 1000, Tolerance::VISIBLE);
        let rough = examiner.examine(KernelId::MollerTrumbore);
        assert!(
            rough[0].counts.visible() > 0 && rough[0].counts.rays == 500 && rough[0].of == 1600,
            "{rough:?}"
        );
        assert!(rough[1].counts.holes > 0 && rough[1].counts.holes <= rough[0].counts.holes, "{rough:?}");
        let exact = examiner.examine_all(KernelId::Exact).counts;
        assert_eq!((exact.visible(), exact.swapped, exact.ties), (0, 0, 0));
        assert_eq!(examiner.examine_all(KernelId::Watertight).counts.holes, 0);
    }
}
