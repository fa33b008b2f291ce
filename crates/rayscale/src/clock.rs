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
}

fn wall() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

#[cfg(unix)]
fn thread() -> u64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

#[cfg(not(unix))]
fn thread() -> u64 {
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
}
