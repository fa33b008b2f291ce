//! What wrong answers are, by exact arithmetic.

use crate::record::Errors;
use crate::stats::quantile;
use accel::{Geometry, Hit, RaySet, Scene};
use oracle::{Oracle, Verdict, classify};
use rayon::prelude::*;

/// The oracle of a scene's triangles; of boxes it knows nothing.
pub fn oracle_of(scene: &Scene) -> Oracle {
    match &scene.geometry {
        Geometry::Triangles(mesh) => Oracle::new((0..mesh.triangles.len()).map(|i| mesh.corners(i))),
        Geometry::Boxes(_) => Oracle::new([]),
    }
}

/// Judges the hits of the rays `numbers` by the exact ones.
///
/// # Panics
/// If a number is not below the set's length.
pub fn judge(oracle: &Oracle, rays: &RaySet, hits: &[Option<Hit>], numbers: &[usize]) -> Errors {
    let judged: Vec<_> =
        numbers.par_iter().map(|i| classify(hits[*i], oracle.closest(&rays.ray(*i)).as_ref())).collect();
    let count = |verdict| judged.iter().filter(|j| j.verdict == verdict).count() as u64;
    let right = judged.iter().filter(|j| j.verdict == Verdict::Agree);
    let ulps: Vec<f64> = right.filter_map(|j| j.t_ulp_error).map(f64::abs).collect();
    Errors {
        missed: count(Verdict::Missed),
        false_hits: count(Verdict::False),
        wrong_object: count(Verdict::WrongObject),
        t_ulp_p99: quantile(&ulps, 0.99).unwrap_or(0.0),
        t_ulp_max: ulps.iter().copied().fold(0.0, f64::max),
        rays_exact: numbers.len() as u64,
    }
}
