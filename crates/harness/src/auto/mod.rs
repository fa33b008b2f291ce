//! `--kernel auto`: the cheapest ray-triangle test that is right often enough for a scene and its rays. Like the structures,
//! it takes no more than what the scene requires.

mod examine;

pub use examine::{Examiner, Wrong};

use crate::registry::{Choice, ChosenKernel};
use crate::workload::Batch;
use accel::{Geometry, Scene};
use primitives::KernelId;
use std::borrow::Cow;

/// Kernels whose errors have to be measured, cheapest first as `rayscale trade` finds them. After these comes
/// [`KernelId::Exact`], which is proven and costs less than [`KernelId::Double`].
pub const MEASURED: [KernelId; 3] = [KernelId::MollerTrumbore, KernelId::BaldwinWeber, KernelId::Watertight];

/// Rays examined for a decision, at most.
const MOST_RAYS: usize = 1 << 20;

/// A kernel and why it was chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The kernel.
    pub kernel: KernelId,
    /// In words, with figures.
    pub reason: String,
}

/// The cheapest kernel that gives at most `max_error` wrong answers in a million of these rays.
pub fn decide(scene: &Scene, batches: &[Batch], max_error: f64) -> Decision {
    let decision = |kernel: KernelId, reason: String| Decision { kernel, reason };
    if !matches!(scene.geometry, Geometry::Triangles(_)) {
        return decision(MEASURED[0], "the scene has no triangles".to_owned());
    }
    let limit = format!("at most {max_error} wrong in a million rays wanted");
    let exact =
        |tried: &str| decision(KernelId::Exact, format!("{limit}; {tried}exact is proven to give none"));
    if max_error <= 0.0 {
        return exact("");
    }
    let mut examiner = Examiner::new(scene, batches, MOST_RAYS);
    let mut tried = String::new();
    for kernel in MEASURED {
        let wrong = examiner.examine_all(kernel);
        let found = format!("{kernel} gives {wrong}");
        if wrong.bound_per_million() <= max_error {
            return decision(kernel, format!("{limit}; {tried}{found}"));
        }
        tried.push_str(&found);
        tried.push_str("; ");
    }
    exact(&tried)
}

/// The choices with every kernel decided that was left to the suite, for a scene and the rays to be traced.
/// Choices that are decided stay so.
pub fn resolve<'c>(choices: &'c [Choice], scene: &Scene, batches: &[Batch]) -> Cow<'c, [Choice]> {
    let mut known: Vec<(f64, Decision)> = Vec::new();
    let mut all = Cow::Borrowed(choices);
    for (i, choice) in choices.iter().enumerate() {
        let ChosenKernel::Auto { max_error } = choice.kernel else { continue };
        let decision = match known.iter().find(|(limit, _)| *limit == max_error) {
            Some((_, decision)) => decision.clone(),
            None => {
                let decision = decide(scene, batches, max_error);
                known.push((max_error, decision.clone()));
                decision
            }
        };
        all.to_mut()[i] = choice.decided(decision.kernel, decision.reason);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Query;
    use crate::{registry, testing};
    use accel::{Need, RaySet};

    fn both(rays: &RaySet) -> [Batch<'_>; 2] {
        [Query::Closest, Query::Occluded].map(|query| Batch { rays, query })
    }

    #[test]
    fn the_limit_decides() {
        let (scene, rays) = testing::from_inside(3000);
        let batches = both(&rays);
        let at = |max_error| decide(&scene, &batches, max_error);
        assert_eq!(at(1e6).kernel, KernelId::MollerTrumbore);
        assert_eq!(at(0.0).kernel, KernelId::Exact);
        assert!(at(0.0).reason.contains("proven"));
        // Every one of these rays was examined, and what is chosen keeps the limit on them.
        let mut examiner = Examiner::new(&scene, &batches, MOST_RAYS);
        let rates = MEASURED.map(|kernel| examiner.examine_all(kernel).per_million());
        for limit in [rates[0], rates[1], rates[2], 1.0, 0.5] {
            let chosen = at(limit.max(1e-9));
            let first = MEASURED.iter().zip(rates).find(|(_, rate)| *rate <= limit.max(1e-9));
            assert_eq!(
                chosen.kernel,
                first.map_or(KernelId::Exact, |(kernel, _)| *kernel),
                "{}",
                chosen.reason
            );
            assert!(chosen.reason.contains("6,000"), "{}", chosen.reason);
        }
    }

    #[test]
    fn choices_are_decided_once_and_others_stay() {
        let (scene, rays) = testing::from_inside(3000);
        let batches = both(&rays);
        let choices = ["ssm:kernel=auto", "minmax:kernel=watertight", "obvhs-bvh2"]
            .map(|id| registry::parse(id).unwrap());
        assert!(choices[0].builder.build(&scene, &Need::GENERAL).is_err(), "it is not decided");
        assert!(choices[0].builder.settings().contains("kernel=auto"));
        let mut limited = choices.to_vec();
        limited[0].kernel = ChosenKernel::Auto { max_error: 0.0 };
        let decided = resolve(&limited, &scene, &batches);
        assert_eq!([0, 1, 2].map(|i| decided[i].kernel()), ["exact", "watertight", "own"]);
        assert_eq!(decided[0].spec, choices[0].spec);
        assert!(decided[0].builder.settings().contains("kernel=exact"));
        assert!(decided[0].reason().contains("proven") && decided[1].reason().is_empty());
        assert!(matches!(resolve(&decided, &scene, &[]), Cow::Borrowed(_)));
        let rays = RaySet::List(vec![rays.ray(0)]);
        let mut hits = [None];
        decided[0].builder.build(&scene, &Need::GENERAL).unwrap().trace(&rays, &mut hits);
        assert!(hits[0].is_some());
    }
}
