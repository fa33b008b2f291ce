//! Answers judged by exact arithmetic.

use crate::stats::quantile;
use crate::workload::Workload;
use accel::{Accel, RaySet};
use oracle::{ExactHit, Oracle, Verdict, classify};
use rayon::prelude::*;
use serde::Serialize;

/// The exact answers to a set of rays.
#[derive(Clone, Debug)]
pub struct Truth(Vec<Option<(u32, ExactHit)>>);

impl Truth {
    /// What the oracle says, on all threads of the current pool.
    pub fn of(oracle: &Oracle, rays: &RaySet) -> Self {
        Self((0..rays.len()).into_par_iter().map(|i| oracle.closest(&rays.ray(i))).collect())
    }
}

/// Errors over all judged sets of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Accuracy {
    /// Rays judged.
    pub rays: u64,
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub false_hits: u64,
    /// A hit of another object than the nearest.
    pub wrong_object: u64,
    /// Rays aimed from inside at faces, edges and corners that do hit something.
    pub leak_rays: u64,
    /// Those of them for which no hit was reported.
    pub leaks: u64,
    /// Rays that start at hit points, rounded and not offset.
    pub spawned: u64,
    /// Those of them reported to hit within 10^-5 of the scene's extent.
    pub self_hits: u64,
    /// Those that truly do, because the rounded origin lies on the near side of the surface.
    pub self_hits_true: u64,
    /// Half of the hits of the right object are off by at most so many units in the last place of t.
    pub t_ulp_median: f64,
    /// 99 % of them.
    pub t_ulp_p99: f64,
    /// All of them.
    pub t_ulp_max: f64,
}

impl Accuracy {
    /// Wrong answers of any kind in a million rays.
    pub fn errors_per_million(&self) -> f64 {
        per_million(self.missed + self.false_hits + self.wrong_object, self.rays)
    }

    /// Leaks in a million rays aimed from inside.
    pub fn leaks_per_million(&self) -> f64 {
        per_million(self.leaks, self.leak_rays)
    }

    /// Self-hits in a million spawned rays.
    pub fn self_hits_per_million(&self) -> f64 {
        per_million(self.self_hits, self.spawned)
    }
}

fn per_million(count: u64, of: u64) -> f64 {
    count as f64 * 1e6 / of.max(1) as f64
}

/// Judges a structure's answers to all sets; `extent` is the scene's.
pub fn judge(accel: &dyn Accel, sets: &[(&Workload, Truth)], extent: f32) -> Accuracy {
    let mut sum = Accuracy::default();
    let mut ulps = Vec::new();
    let close = f64::from(extent) * 1e-5;
    for (set, Truth(truth)) in sets {
        let mut hits = vec![None; set.rays.len()];
        accel.trace(&set.rays, &mut hits);
        let leaking = set.id.starts_inside();
        let spawned = set.id.starts_on_surfaces();
        for (i, (hit, exact)) in hits.iter().zip(truth).enumerate() {
            let judgement = classify(*hit, exact.as_ref());
            sum.rays += 1;
            sum.leak_rays += u64::from(leaking && exact.is_some());
            match judgement.verdict {
                Verdict::Agree => ulps.extend(judgement.t_ulp_error.map(f64::abs)),
                Verdict::Missed => {
                    sum.missed += 1;
                    sum.leaks += u64::from(leaking);
                }
                Verdict::False => sum.false_hits += 1,
                Verdict::WrongObject => sum.wrong_object += 1,
            }
            if spawned {
                let length = f64::from(set.rays.ray(i).direction.length());
                let near = |t: f64| u64::from(t * length < close);
                sum.spawned += 1;
                sum.self_hits += hit.map_or(0, |hit| near(hit.t.into()));
                sum.self_hits_true += exact.as_ref().map_or(0, |(_, hit)| near(hit.t.to_f64()));
            }
        }
    }
    sum.t_ulp_median = quantile(&ulps, 0.5).unwrap_or(0.0);
    sum.t_ulp_p99 = quantile(&ulps, 0.99).unwrap_or(0.0);
    sum.t_ulp_max = ulps.iter().copied().fold(0.0, f64::max);
    sum
}
