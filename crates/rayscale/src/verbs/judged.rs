//! Hits of an image judged by the exact ones.

use accel::{Hit, RaySet, Scene};
use harness::judge::{Judge, Kind, Tolerance, TrueHit};
use harness::registry;
use primitives::KernelId;
use rayon::prelude::*;

/// The exact hits of a set of rays.
pub fn exact(scene: &Scene, rays: &RaySet) -> Vec<Option<Hit>> {
    let accel = registry::quick(scene, KernelId::Exact);
    let mut hits = vec![None; rays.len()];
    accel.trace(rays, &mut hits);
    hits
}

/// What is wrong with each hit. Those that differ from the exact ones in any bit of t or in the object are judged by the oracle.
pub fn kinds(scene: &Scene, rays: &RaySet, hits: &[Option<Hit>], exact: &[Option<Hit>]) -> Vec<Option<Kind>> {
    let judge = Judge::new(scene, Tolerance::VISIBLE);
    let place = |hit: &Option<Hit>| hit.map(|hit| (hit.object, hit.t.to_bits()));
    let one = |i: usize| {
        if place(&hits[i]) == place(&exact[i]) {
            return None;
        }
        let ray = rays.ray(i);
        let truth = judge.oracle().closest(&ray);
        judge.judge(&ray, hits[i], truth.as_ref().map(TrueHit::of).as_ref()).kind
    };
    (0..rays.len()).into_par_iter().map(one).collect()
}
