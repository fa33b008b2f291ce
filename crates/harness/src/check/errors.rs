//! What wrong answers are, by exact arithmetic.

use crate::record::Errors;
use accel::{Geometry, Hit, RaySet, Scene};
use judge::{Judge, Tally, TrueHit};
use oracle::{Oracle, Verdict, classify};
use rayon::prelude::*;

/// The oracle of a scene's triangles; of boxes and solids it knows nothing.
pub fn oracle_of(scene: &Scene) -> Oracle {
    match &scene.geometry {
        Geometry::Triangles(mesh) => Oracle::new((0..mesh.triangles.len()).map(|i| mesh.corners(i))),
        Geometry::Boxes(_) | Geometry::Solids(_) => Oracle::new([]),
    }
}

/// Judges the hits of the rays `numbers` by the exact ones.
///
/// # Panics
/// If a number is not below the set's length.
pub fn judge(judge: &Judge, rays: &RaySet, hits: &[Option<Hit>], numbers: &[usize]) -> Errors {
    let one = |i: &usize| {
        let (ray, hit) = (rays.ray(*i), hits[*i]);
        let exact = judge.oracle().closest(&ray);
        let truth = exact.as_ref().map(TrueHit::of);
        (classify(hit, exact.as_ref()).verdict, judge.judge(&ray, hit, truth.as_ref()))
    };
    let judged: Vec<_> = numbers.par_iter().map(one).collect();
    let count = |verdict| judged.iter().filter(|(found, _)| *found == verdict).count() as u64;
    let mut tally = Tally::default();
    judged.iter().for_each(|(_, judgement)| tally.add(judgement));
    let space = tally.errors();
    Errors {
        missed: count(Verdict::Missed),
        false_hits: count(Verdict::False),
        wrong_object: count(Verdict::WrongObject),
        kinds: Some(tally.counts),
        t_ulp_p99: space.t_ulps.p99,
        t_ulp_max: space.t_ulps.largest,
        rays_exact: numbers.len() as u64,
    }
}
