//! One measurement: a structure on a scene's ray set.

use super::{Intersector, Outcome};
use crate::stats;
use judge::Counts;
use scenes::rays::{Query, RaysId};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A structure on a scene's ray set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Scene.
    pub scene: String,
    /// Ray set.
    pub rays: String,
    /// What was asked of every ray.
    pub query: Query,
    /// Structure, by its name in [`super::Record::structures`].
    pub structure: String,
    /// Ray-triangle intersector.
    pub kernel: Intersector,
    /// Why this ray-triangle test was chosen, where that was left to the suite.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kernel_reason: String,
    /// Threads that built and traced.
    pub threads: usize,
    /// Rays in a sample. Structures whose time grows with the number of objects trace fewer.
    pub ray_count: u64,
    /// Rays of them that hit.
    pub hits: u64,
    /// Build times in ns, in the order taken.
    pub build_ns: Vec<u64>,
    /// Times for all rays in ns, in the order taken.
    pub trace_ns: Vec<u64>,
    /// How many of them each pass over the scene took: between passes there is time, and structures are built anew.
    /// Empty in records of old, which were taken in one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub passes: Vec<usize>,
    /// Summary of the trace times; none where there is no sample.
    pub ns_per_ray: Option<Timing>,
    /// Memory.
    pub bytes: Option<Bytes>,
    /// What the structure chose and why, in its own words.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub plan: String,
    /// Steps per ray by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counters: Option<BTreeMap<String, f64>>,
    /// Against brute force.
    pub check: Option<Check>,
    /// Whether there are figures, and why not.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// What makes a cell comparable: all but the structure.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key {
    /// Scene.
    pub scene: String,
    /// Ray set.
    pub rays: String,
    /// Threads.
    pub threads: usize,
}

/// The id in a structure's name: what stands before the settings.
pub fn id_of(structure: &str) -> &str {
    structure.split_once(':').map_or(structure, |(id, _)| id)
}

impl Cell {
    /// The ray set, if this program knows it.
    pub fn ray_set(&self) -> Option<RaysId> {
        self.rays.parse().ok()
    }

    /// Whether its rays are the camera rays of an image.
    pub fn is_image(&self) -> bool {
        self.ray_set().is_some_and(RaysId::is_image)
    }

    /// The structure's id, without settings.
    pub fn structure_id(&self) -> &str {
        id_of(&self.structure)
    }

    /// What the cell shares with those it can be compared with.
    pub fn key(&self) -> Key {
        Key { scene: self.scene.clone(), rays: self.rays.clone(), threads: self.threads }
    }

    /// Median ns per ray, unless the cell failed.
    pub fn ns(&self) -> Option<f64> {
        self.ns_per_ray.as_ref().filter(|_| self.outcome.is_measured()).map(|timing| timing.median)
    }

    /// Median build time in ns, unless the cell failed.
    pub fn build(&self) -> Option<f64> {
        let samples: Vec<f64> = self.build_ns.iter().map(|ns| *ns as f64).collect();
        stats::median(&samples).filter(|_| self.outcome.is_measured())
    }

    /// Samples in ns per ray.
    pub fn samples_per_ray(&self) -> Vec<f64> {
        let rays = self.ray_count.max(1) as f64;
        self.trace_ns.iter().map(|ns| *ns as f64 / rays).collect()
    }

    /// Samples in ns per ray, pass by pass.
    pub fn passes_per_ray(&self) -> Vec<Vec<f64>> {
        let samples = self.samples_per_ray();
        // A record that somebody else wrote may say any numbers.
        let taken = self.passes.iter().try_fold(0usize, |sum, pass| sum.checked_add(*pass));
        if taken != Some(samples.len()) {
            return vec![samples];
        }
        let mut rest = samples.as_slice();
        let mut next = |n: &usize| {
            let (pass, others) = rest.split_at(*n);
            rest = others;
            pass.to_vec()
        };
        self.passes.iter().map(&mut next).collect()
    }

    /// Sets the summary by the samples.
    pub fn summarise(&mut self) {
        self.ns_per_ray = stats::summary(&self.samples_per_ray()).map(|s| Timing {
            median: s.median,
            mad: s.mad,
            min: s.min,
        });
    }
}

/// Time for a ray in ns over the samples of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Median.
    pub median: f64,
    /// Median absolute deviation from the median.
    pub mad: f64,
    /// Least.
    pub min: f64,
}

/// Memory of a built structure in bytes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bytes {
    /// What the method adds.
    pub structure: u64,
    /// What it copies of the scene.
    pub geometry_copy: u64,
    /// Most bytes in use at once during the build, what remains included; none where the
    /// structure allocates outside this program's allocator.
    pub peak_build: Option<u64>,
    /// What the allocator saw left after the build; none as above.
    #[serde(default)]
    pub allocated: Option<u64>,
    /// The parts by name.
    pub parts: BTreeMap<String, u64>,
}

/// Hits compared with brute force.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Rays compared, spread evenly over the set.
    pub rays_checked: u64,
    /// Rays of them whose answers are not equal bit for bit.
    pub differences: u64,
    /// For structures with a ray-triangle test of their own: what the differences are,
    /// decided by exact arithmetic.
    #[serde(flatten)]
    pub errors: Option<Errors>,
}

/// Wrong answers by exact arithmetic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub false_hits: u64,
    /// A hit of another object than the nearest.
    pub wrong_object: u64,
    /// The same answers by what they do; none in records of old.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinds: Option<Counts>,
    /// 99 % of the hits of the right surface are off by at most so many units in the last
    /// place of t, over the rays decided exactly. In records of old t near 0 counts too, where such units say little.
    pub t_ulp_p99: f64,
    /// The largest error of t in such units.
    pub t_ulp_max: f64,
    /// Rays decided exactly: those that differ from brute force, and a sample of the rest.
    pub rays_exact: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summaries_are_per_ray_and_failed_cells_have_no_time() {
        let mut cell = crate::testing::cell("s", "parallel", "x", 20.0);
        cell.ray_count = 10;
        cell.trace_ns = vec![100, 300, 200];
        cell.build_ns = vec![5, 7, 6];
        cell.summarise();
        assert_eq!(cell.ns_per_ray, Some(Timing { median: 20.0, mad: 10.0, min: 10.0 }));
        assert_eq!((cell.ns(), cell.build()), (Some(20.0), Some(6.0)));
        assert_eq!(cell.passes_per_ray(), [[10.0, 30.0, 20.0]]);
        cell.passes = vec![1, 2];
        assert_eq!(cell.passes_per_ray(), [vec![10.0], vec![30.0, 20.0]]);
        for nonsense in [vec![usize::MAX, 4], vec![2]] {
            cell.passes = nonsense;
            assert_eq!(cell.passes_per_ray(), [[10.0, 30.0, 20.0]]);
        }
        cell.outcome = Outcome::Failed("lost hits".into());
        assert_eq!((cell.ns(), cell.build()), (None, None));
    }
}
