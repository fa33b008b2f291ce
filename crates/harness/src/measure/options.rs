//! How much is measured.

use lanes::Level;
use std::time::Duration;

/// How much is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Threads that build and trace. Recorded; the caller provides the pool.
    pub threads: usize,
    /// Passes over the ray sets of a scene, which share the samples. Each begins with other builds, where there is time
    /// for them, so that samples differ in when they were taken and in how memory was laid out, as those of other
    /// runs do.
    pub passes: usize,
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
    /// Rays of an external structure judged exactly, besides those that differ from brute force.
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
            passes: 3,
            rounds: 7,
            least_rounds: 3,
            cell_time: Duration::from_millis(250),
            build_rounds: 5,
            least_builds: 3,
            build_time: Duration::from_secs(1),
            check_tests: speed * 100_000_000,
            exact_rays: 500,
            linear_tests: 8_000_000,
            sample_time: Duration::from_secs(4),
            counters: false,
        }
    }
}

impl Options {
    /// Passes that there are samples for.
    pub fn passes(&self) -> usize {
        self.passes.clamp(1, self.rounds.max(1))
    }

    /// How many of `all` samples are due by the end of a pass, the first being pass 0.
    pub(super) fn due(&self, all: usize, pass: usize) -> usize {
        (all * (pass + 1)).div_ceil(self.passes())
    }

    /// How much of a time.
    pub(super) fn time_due(&self, all: Duration, pass: usize) -> Duration {
        all.mul_f64((pass + 1) as f64 / self.passes() as f64)
    }
}
