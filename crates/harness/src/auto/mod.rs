//! `--kernel auto`: the cheapest ray-triangle test that is right often enough for a scene and its rays. Like the structures,
//! it takes no more than what the scene requires.

mod cost;
mod examine;

pub use examine::Examiner;

use crate::registry::{Choice, ChosenKernel};
use crate::units;
use crate::workload::Batch;
use accel::{Geometry, Scene};
use cost::costs;
use judge::{Examined, Limits, Tolerance};
use primitives::KernelId;
use std::borrow::Cow;
use std::fmt::Write;

/// Kernels that are tried ([`KernelId::is_tried`]); the last is proven.
pub fn tried() -> Vec<KernelId> {
    KernelId::ALL.into_iter().filter(|kernel| kernel.is_tried()).collect()
}

/// Rays examined for a decision, at most.
const MAX_RAYS: usize = 1 << 20;

/// A kernel and why it was chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The kernel.
    pub kernel: KernelId,
    /// In words, with figures.
    pub reason: String,
    /// Kernels by their cost in this structure, the cheapest first; empty where there was nothing to decide.
    pub trials: Vec<Trial>,
}

/// A kernel that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Which.
    pub kernel: KernelId,
    /// ns per ray in the structure that it was chosen for; none where it can't be built or traced.
    pub ns: Option<f64>,
    /// Its errors; none where a cheaper one was chosen.
    pub found: Option<Examined>,
}

/// Decides kernels for the rays of a scene; what is known of a kernel's errors holds for all structures.
pub struct Decider<'s> {
    scene: &'s Scene,
    batches: &'s [Batch<'s>],
    examiner: Option<Examiner<'s>>,
}

impl<'s> Decider<'s> {
    /// For these rays, all of them up to a million.
    pub const fn new(scene: &'s Scene, batches: &'s [Batch<'s>]) -> Self {
        Self { scene, batches, examiner: None }
    }

    /// The cheapest kernel in the structure of `choice` that keeps the limits on these rays.
    pub fn decide(&mut self, choice: &Choice, limits: &Limits) -> Decision {
        let plain = |kernel, reason: String| Decision { kernel, reason, trials: Vec::new() };
        if !matches!(self.scene.geometry, Geometry::Triangles(_)) {
            return plain(KernelId::MollerTrumbore, "the scene has no triangles".to_owned());
        }
        if limits.ask_for_none() {
            return plain(
                KernelId::Exact,
                format!("{} wanted; exact is proven to give none", limits.words()),
            );
        }
        let tried = tried();
        let ns = costs(choice, self.scene, self.batches, &tried);
        let trial = |(kernel, ns)| Trial { kernel, ns, found: None };
        let mut trials: Vec<Trial> = tried.into_iter().zip(ns).map(trial).collect();
        trials.sort_by(|a, b| a.ns.unwrap_or(f64::INFINITY).total_cmp(&b.ns.unwrap_or(f64::INFINITY)));
        let mut reason = format!("{} wanted", limits.words());
        let mut kernel = KernelId::Exact;
        for trial in &mut trials {
            let cost = trial.ns.map_or("no time".to_owned(), units::time);
            let proven = trial.kernel == KernelId::Exact;
            // Writing to a string does not fail.
            let _ = if proven {
                write!(reason, "; exact takes {cost} and is proven to give none")
            } else {
                let found = self.examiner().examine_all(trial.kernel);
                trial.found = Some(found);
                write!(reason, "; {} takes {cost} and gives {}", trial.kernel, found.words(limits.counted))
            };
            if proven || trial.found.is_some_and(|found| limits.kept_by(&found)) {
                kernel = trial.kernel;
                break;
            }
        }
        Decision { kernel, reason, trials }
    }

    fn examiner(&mut self) -> &mut Examiner<'s> {
        let (scene, batches) = (self.scene, self.batches);
        self.examiner.get_or_insert_with(|| Examiner::new(scene, batches, MAX_RAYS, Tolerance::VISIBLE))
    }
}

/// The choices with every kernel decided that was left to the suite, for a scene and the rays to be traced.
/// Choices that are decided stay so.
pub fn resolve<'c>(choices: &'c [Choice], scene: &Scene, batches: &[Batch]) -> Cow<'c, [Choice]> {
    let mut decider = Decider::new(scene, batches);
    let mut all = Cow::Borrowed(choices);
    for (i, choice) in choices.iter().enumerate() {
        let ChosenKernel::Auto { limits } = &choice.kernel else { continue };
        let Decision { kernel, reason, .. } = decider.decide(choice, limits);
        all.to_mut()[i] = choice.decided(kernel, reason);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Query;
    use crate::{registry, testing};
    use accel::{RaySet, Workload};

    fn both(rays: &RaySet) -> [Batch<'_>; 2] {
        [Query::Closest, Query::Occluded].map(|query| Batch { rays, query })
    }

    fn at_most(errors: f64) -> Limits {
        Limits { errors: Some(errors), ..Limits::NONE }
    }

    /// By its own record: what was cheaper did not keep the limits.
    fn is_sensible(decision: &Decision, limits: &Limits) {
        let place = decision.trials.iter().position(|trial| trial.kernel == decision.kernel).unwrap();
        let (cheaper, chosen) = (&decision.trials[..place], decision.trials[place]);
        let keeps = |trial: &Trial| trial.found.is_some_and(|found| limits.kept_by(&found));
        assert!(!cheaper.iter().any(keeps), "{}", decision.reason);
        assert!(chosen.kernel == KernelId::Exact || keeps(&chosen), "{}", decision.reason);
        assert!(decision.trials.is_sorted_by_key(|trial| trial.ns.unwrap_or(f64::INFINITY)));
    }

    #[test]
    fn the_limit_decides_among_kernels_by_their_cost() {
        let (scene, rays) = testing::from_inside(3000);
        let batches = both(&rays);
        let mut decider = Decider::new(&scene, &batches);
        for structure in ["ssm", "bmssm", "minmax"] {
            let choice = registry::parse(&format!("{structure}:kernel=auto")).unwrap();
            let none = decider.decide(&choice, &at_most(0.0));
            assert!(none.kernel == KernelId::Exact && none.reason.contains("proven"));
            for limit in [1e6, 1.0, 0.5, 1e-9] {
                let decision = decider.decide(&choice, &at_most(limit));
                is_sensible(&decision, &at_most(limit));
                assert_eq!(decision.trials.len(), tried().len());
                assert!(decision.kernel == KernelId::Exact || decision.reason.contains("6,000"));
            }
        }
    }

    #[test]
    fn what_leaks_is_not_chosen_however_cheap() {
        let (scene, rays) = crate::testing::distant_corners();
        let batches = both(&rays);
        let mut decider = Decider::new(&scene, &batches);
        let choice = registry::parse("ssm:kernel=auto").unwrap();
        let tight = Limits { holes: Some(0.0), ..Limits::NONE };
        let decision = decider.decide(&choice, &tight);
        is_sensible(&decision, &tight);
        assert!(decision.kernel.is_watertight(), "{}", decision.reason);
        let near = Limits { displacement: Some(0.0), ..Limits::NONE };
        assert_eq!(decider.decide(&choice, &near).kernel, KernelId::Exact);
    }

    #[test]
    fn choices_are_decided_and_others_stay() {
        let (scene, rays) = testing::from_inside(3000);
        let batches = both(&rays);
        let choices = ["ssm:kernel=auto", "minmax:kernel=watertight", "obvhs-bvh2"]
            .map(|id| registry::parse(id).unwrap());
        assert!(choices[0].builder.build(&scene, &Workload::GENERAL).is_err(), "it is not decided");
        assert!(choices[0].builder.settings().contains("kernel=auto"));
        let mut limited = choices.to_vec();
        limited[0].kernel = ChosenKernel::Auto { limits: at_most(0.0) };
        let decided = resolve(&limited, &scene, &batches);
        assert_eq!([0, 1, 2].map(|i| decided[i].kernel()), ["exact", "watertight", "own"]);
        assert_eq!(decided[0].spec, choices[0].spec);
        assert!(decided[0].builder.settings().contains("kernel=exact"));
        assert!(decided[0].reason().contains("proven") && decided[1].reason().is_empty());
        assert!(matches!(resolve(&decided, &scene, &[]), Cow::Borrowed(_)));
        let rays = RaySet::List(vec![rays.ray(0)]);
        let mut hits = [None];
        decided[0].builder.build(&scene, &Workload::GENERAL).unwrap().trace(&rays, &mut hits);
        assert!(hits[0].is_some());
    }
}
