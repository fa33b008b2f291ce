//! Measuring: builds first, then rays, round by round over all structures of a scene.
//!
//! Build times, trace times and memory come from separate runs. The first build is
//! watched for memory and not timed; the first trace warms up, is compared with brute force
//! and not timed. After every timed trace all answers are compared with those of the first,
//! outside of the timed section.

mod build;
mod guard;
mod memory;
mod pace;
mod resume;
mod scene;
mod session;
#[cfg(test)]
mod tests;
mod trace;
mod watch;

pub use build::guarded_build;
pub use guard::guard;
pub use memory::{RESOLUTIONS, memory_rows};
pub use pace::in_time;
pub use resume::{ResumeError, resume};
pub use scene::{Job, measure};
pub use session::{Session, SessionError, begin, run, workloads};
pub use watch::Watch;

use accel::simd::Level;
use std::time::Duration;

/// How much is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Threads that build and trace. Recorded; the caller provides the pool.
    pub threads: usize,
    /// Most samples of a cell.
    pub rounds: usize,
    /// Fewest samples of a cell, whatever the time.
    pub least_rounds: usize,
    /// Time for the samples of a cell, after which no new round begins.
    pub cell_time: Duration,
    /// Most samples of a build.
    pub build_rounds: usize,
    /// Fewest samples of a build, whatever the time.
    pub least_builds: usize,
    /// Time for the samples of a structure's build, likewise.
    pub build_time: Duration,
    /// Ray-object tests of brute force for the check of a ray set.
    pub check_tests: u64,
    /// Rays of a foreign structure judged exactly, besides those that differ from brute force.
    pub exact_rays: usize,
    /// Box tests in a sample of a structure whose time grows with the number of objects.
    pub linear_tests: u64,
    /// Time for one sample: a structure that would take longer gets a quarter of the rays, or a sixteenth, …
    pub sample_time: Duration,
    /// Whether steps are counted.
    pub counters: bool,
}

impl Default for Options {
    fn default() -> Self {
        // Brute force does about so many tests in a tenth of a second.
        let speed = if Level::best() == Level::Portable { 1 } else { 4 };
        Self {
            threads: 1,
            rounds: 7,
            least_rounds: 3,
            cell_time: Duration::from_millis(250),
            build_rounds: 5,
            least_builds: 3,
            build_time: Duration::from_millis(300),
            check_tests: speed * 100_000_000,
            exact_rays: 500,
            linear_tests: 8_000_000,
            sample_time: Duration::from_secs(4),
            counters: false,
        }
    }
}
