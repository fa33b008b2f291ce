//! Times of the studies that take their own: fewer samples than a measurement, taken in turns.

use accel::Accel;
use harness::answers::Answers;
use harness::clock::Clock;
use harness::guard::guard;
use harness::stats::geometric_mean;
use scenes::rays::Query;

/// ns per ray of several structures over sets of rays: the least of `rounds` samples taken in turns, geometric means over the
/// sets. `None` where one panics.
pub fn times(accels: &[&dyn Accel], sets: &[(&accel::RaySet, Query)], rounds: usize) -> Vec<Option<f64>> {
    let clock = Clock::of(rayon::current_num_threads());
    let mut all = vec![Some(Vec::new()); accels.len()];
    for (rays, query) in sets.iter().filter(|(rays, _)| !rays.is_empty()) {
        let mut answers = Answers::new(*query, rays.len());
        let mut least = vec![Some(f64::INFINITY); accels.len()];
        for _ in 0..rounds.max(1) {
            for (accel, least) in accels.iter().zip(&mut least) {
                let start = clock.now();
                let traced = guard("tracing", || answers.trace(*accel, rays));
                let ns = (clock.now() - start).max(1) as f64 / rays.len() as f64;
                *least = least.filter(|_| traced.is_ok()).map(|known| known.min(ns));
            }
        }
        for (sum, ns) in all.iter_mut().zip(least) {
            match (&mut *sum, ns) {
                (Some(sum), Some(ns)) => sum.push(ns),
                _ => *sum = None,
            }
        }
    }
    all.into_iter().map(|ns| geometric_mean(&ns?)).collect()
}
