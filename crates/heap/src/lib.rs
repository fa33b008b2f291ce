//! How much of the heap is in use, and what happens when it gives no more.
//!
//! The numbers come from [`Counting`], where a program makes it its global allocator and calls
//! [`start_counting`]; elsewhere [`counting`] is false and all numbers are 0.

mod counting;

pub use counting::Counting;

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

static COUNTING: AtomicBool = AtomicBool::new(false);
static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// `bytes` more are in use.
#[inline]
fn grown(bytes: usize) {
    let live = LIVE.fetch_add(bytes, Relaxed).wrapping_add(bytes);
    if live > PEAK.load(Relaxed) {
        PEAK.fetch_max(live, Relaxed);
    }
}

/// `bytes` fewer are in use.
#[inline]
fn shrunk(bytes: usize) {
    LIVE.fetch_sub(bytes, Relaxed);
}

/// From how many bytes on allocations are counted down in [`LEFT`]; none as a rule.
static MIN: AtomicUsize = AtomicUsize::new(usize::MAX);
static LEFT: AtomicUsize = AtomicUsize::new(0);

/// Whether an allocation is the one to be refused.
#[inline]
fn is_refused(bytes: usize) -> bool {
    bytes >= MIN.load(Relaxed) && LEFT.fetch_sub(1, Relaxed) == 0
}

/// Does `work`, and refuses one of its allocations of at least `least` bytes: that before which there were `before`. Says
/// whether it came so far. Other threads' allocations count as well; nothing is refused where [`Counting`] is not the allocator.
pub fn refusing<T>(before: usize, least: usize, work: impl FnOnce() -> T) -> (T, bool) {
    LEFT.store(before, Relaxed);
    MIN.store(least, Relaxed);
    let out = work();
    MIN.store(usize::MAX, Relaxed);
    // Counted down beyond 0 it is greater than it was.
    (out, LEFT.load(Relaxed) > before)
}

/// For the program: its global allocator reports here.
pub fn start_counting() {
    COUNTING.store(true, Relaxed);
}

/// Whether the program's allocator reports here.
pub fn counting() -> bool {
    COUNTING.load(Relaxed)
}

/// What some work did to the heap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Bytes in use after the work beyond those before, negative where it freed more.
    pub left: i64,
    /// Most bytes in use during the work beyond those before.
    pub peak: u64,
}

/// Does `work` and says what it did to the heap; nothing of that where nobody counts. Other threads' doings count
/// as well.
pub fn observe<T>(work: impl FnOnce() -> T) -> (T, Option<Use>) {
    let before = LIVE.load(Relaxed);
    PEAK.store(before, Relaxed);
    let out = work();
    let left = LIVE.load(Relaxed) as i64 - before as i64;
    let peak = PEAK.load(Relaxed).saturating_sub(before) as u64;
    (out, counting().then_some(Use { left, peak }))
}
