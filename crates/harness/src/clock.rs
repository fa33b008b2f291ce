//! Clocks for samples.

use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use std::time::Instant;

/// What a sample's time is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Clock {
    /// Time that the thread ran: what other programs take of the processor doesn't count.
    Thread,
    /// Time that passed.
    #[default]
    Wall,
}

impl Clock {
    /// The clock for work that so many threads do: one thread's own where the system has such a clock.
    pub const fn of(threads: usize) -> Self {
        if threads == 1 && cfg!(unix) { Self::Thread } else { Self::Wall }
    }

    /// Nanoseconds since some moment that stays the same for a thread.
    pub fn now(self) -> u64 {
        match self {
            Self::Thread => thread(),
            Self::Wall => wall(),
        }
    }

    /// As [`Clock::now`] for builds: of one thread, the time that all threads of this program ran, for a
    /// library may build in threads of its own.
    pub fn now_of_build(self) -> u64 {
        match self {
            Self::Thread => process(),
            Self::Wall => wall(),
        }
    }
}

fn wall() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

#[cfg(unix)]
fn thread() -> u64 {
    by(rustix::time::ClockId::ThreadCPUTime)
}

#[cfg(unix)]
fn process() -> u64 {
    by(rustix::time::ClockId::ProcessCPUTime)
}

#[cfg(unix)]
fn by(clock: rustix::time::ClockId) -> u64 {
    let time = rustix::time::clock_gettime(clock);
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

#[cfg(not(unix))]
fn thread() -> u64 {
    wall()
}

#[cfg(not(unix))]
fn process() -> u64 {
    wall()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn only_the_wall_clock_goes_on_in_sleep() {
        let asleep = |clock: Clock| {
            let start = clock.now();
            std::thread::sleep(Duration::from_millis(100));
            clock.now() - start
        };
        assert!(asleep(Clock::Wall) >= 100_000_000);
        assert!(cfg!(not(unix)) || asleep(Clock::of(1)) < 90_000_000);
        assert_eq!(Clock::of(2), Clock::Wall);
    }

    #[test]
    fn builds_count_the_work_of_every_thread() {
        let start = Clock::Thread.now_of_build();
        let work = || (0..20_000_000u64).fold(1u64, |a, b| std::hint::black_box(a ^ b));
        let taken = std::thread::spawn(move || {
            let start = Clock::Thread.now();
            std::hint::black_box(work());
            Clock::Thread.now() - start
        });
        let taken = taken.join().unwrap();
        assert!(Clock::Thread.now_of_build() - start >= taken);
    }
}
