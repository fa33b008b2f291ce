//! Interleaved timing of passes.

use super::candidates::quantile;

/// A pass is repeated until it takes so long: the clock's steps must not show.
const LEAST_NS: f64 = 200_000.0;

/// Median nanoseconds of each pass, over `rounds` rounds in which all passes take turns. A pass is told the
/// round, so that rounds may differ in what they do.
pub fn medians(rounds: usize, passes: &mut [&mut dyn FnMut(usize)]) -> Vec<f64> {
    let mut samples = vec![Vec::with_capacity(rounds); passes.len()];
    for round in 0..rounds {
        for (pass, samples) in passes.iter_mut().zip(&mut samples) {
            // The first turn warms caches and branch predictors and tells how often to repeat.
            let first = once(1, round, pass).max(1.0);
            let repeats = (LEAST_NS / first).ceil().clamp(1.0, 1e4) as u32;
            samples.push(once(repeats, round, pass));
        }
    }
    samples.iter().map(|samples| quantile(samples, 0.5)).collect()
}

fn once(repeats: u32, round: usize, pass: &mut &mut dyn FnMut(usize)) -> f64 {
    let start = now();
    for _ in 0..repeats {
        pass(round);
    }
    (now() - start) / f64::from(repeats)
}

/// Nanoseconds that this thread has run: what other programs take of the processor doesn't count.
#[cfg(unix)]
fn now() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 * 1e9 + time.tv_nsec as f64
}

/// Nanoseconds since the first call.
#[cfg(not(unix))]
fn now() -> f64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed().as_nanos() as f64
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
