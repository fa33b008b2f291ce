//! Interleaved timing of passes.

use super::candidates::quantile;
use harness::clock::Clock;

/// A pass is repeated until it takes so long: the clock's steps must not show.
const MIN_NS: f64 = 200_000.0;

/// Median nanoseconds of each pass, over `rounds` rounds in which all passes take turns. A pass is told the
/// round, so that rounds may differ in what they do.
pub fn medians(rounds: usize, passes: &mut [&mut dyn FnMut(usize)]) -> Vec<f64> {
    let mut samples = vec![Vec::with_capacity(rounds); passes.len()];
    for round in 0..rounds {
        for (pass, samples) in passes.iter_mut().zip(&mut samples) {
            // The first turn warms caches and branch predictors and tells how often to repeat.
            let first = once(1, round, pass).max(1.0);
            let repeats = (MIN_NS / first).ceil().clamp(1.0, 1e4) as u32;
            samples.push(once(repeats, round, pass));
        }
    }
    samples.iter().map(|samples| quantile(samples, 0.5)).collect()
}

fn once(repeats: u32, round: usize, pass: &mut &mut dyn FnMut(usize)) -> f64 {
    let clock = Clock::of(1);
    let start = clock.now();
    for _ in 0..repeats {
        pass(round);
    }
    (clock.now() - start) as f64 / f64::from(repeats)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pass_takes_its_turn_in_every_round() {
        let (mut a, mut b) = (Vec::new(), 0u64);
        let mut sum = 0u64;
        let times = medians(
            3,
            &mut [
                &mut |round| {
                    a.push(round);
                    (0..1000).for_each(|i| sum = std::hint::black_box(sum + i));
                },
                &mut |_| b += 1,
            ],
        );
        a.dedup();
        assert_eq!(a, [0, 1, 2]);
        assert!(times[0] > 0.0 && b >= 6);
    }
}
