//! What ends a run before its work is done: an interruption, or the end of its time.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Looked at between builds, samples and ray sets.
#[derive(Clone, Debug)]
pub struct Deadline {
    interrupted: Arc<AtomicBool>,
    started: Instant,
    most: Option<Duration>,
}

impl Default for Deadline {
    fn default() -> Self {
        Self::new(Arc::default(), None)
    }
}

impl Deadline {
    /// Time runs from now on; `interrupted` is set from outside, `most` is the time for all.
    pub fn new(interrupted: Arc<AtomicBool>, most: Option<Duration>) -> Self {
        Self { interrupted, started: Instant::now(), most }
    }

    /// Whether to stop at once; what is half done is dropped.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Time left, if it is limited.
    pub fn left(&self) -> Option<Duration> {
        self.most.map(|most| most.saturating_sub(self.started.elapsed()))
    }

    /// Whether nothing new is to begin.
    pub fn is_over(&self) -> bool {
        self.interrupted() || self.left() == Some(Duration::ZERO)
    }
}
