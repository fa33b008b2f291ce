//! What is measured: the ray sets of a scene with what is asked of each ray.

mod pace;
mod subset;

pub use pace::in_time;
pub use subset::{pick, sample, subsample};

use crate::record::Query;
use crate::registry;
use accel::{RaySet, Scene};
use primitives::KernelId;
use scenes::rays::{self, RaysError, RaysId, RaysSpec};

/// Ray sets of scenes, as they are asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Subject {
    /// Scenes by name.
    pub scenes: Vec<String>,
    /// Ray sets.
    pub rays: Vec<RaysId>,
    /// Rows and columns of rasters; lists have as many rays.
    pub size: u32,
    /// Seed of lists.
    pub seed: u64,
}

/// A ray set of a scene and what is asked of its rays.
#[derive(Clone, Debug, PartialEq)]
pub struct RayQuery {
    /// Which ray set.
    pub id: RaysId,
    /// The rays.
    pub rays: RaySet,
    /// What is asked of each.
    pub query: Query,
}

impl RayQuery {
    /// The rays and what is asked of them, whatever set they are of.
    pub fn batch(&self) -> Batch<'_> {
        Batch { rays: &self.rays, query: self.query }
    }
}

/// Rays and what is asked of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Batch<'r> {
    /// The rays.
    pub rays: &'r RaySet,
    /// What is asked of each.
    pub query: Query,
}

/// Ray sets without their names.
pub fn batches(queries: &[RayQuery]) -> Vec<Batch<'_>> {
    queries.iter().map(RayQuery::batch).collect()
}

/// The ray sets of a scene, with what is asked of their rays.
#[derive(Debug, Default)]
pub struct RayQueries {
    /// Those that the scene has rays for.
    pub made: Vec<RayQuery>,
    /// Ray sets that it has no rays for, and why.
    pub left_out: Vec<(RaysId, RaysError)>,
}

/// Makes ray sets of a scene: images of `size` rows and columns, batches of as many rays.
pub fn make(scene: &Scene, sets: &[RaysId], size: u32, seed: u64) -> RayQueries {
    let tracer = registry::quick(scene, KernelId::MollerTrumbore);
    let mut all = RayQueries::default();
    for id in sets {
        let spec = RaysSpec { id: *id, rows: size, cols: size, seed };
        match rays::generate(scene, &spec, tracer.as_ref()) {
            Ok(rays) => all.made.push(RayQuery { id: *id, rays, query: id.query() }),
            Err(error) => all.left_out.push((*id, error)),
        }
    }
    all
}
