//! Work that may not end.

use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// What the work comes to, done by a thread of its own with a rayon pool of its own; nothing if it does not end in time: the thread is
/// then left to itself, as nothing can end it.
///
/// # Panics
/// If the work does, or there is no thread for it.
pub fn within<T: Send + 'static>(time: Duration, work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let (ended, end) = mpsc::channel();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let worker = std::thread::spawn(move || {
        let done = alone.install(work);
        // Nobody listens where time was up.
        let _ = ended.send(done);
    });
    match end.recv_timeout(time) {
        Ok(done) => Some(done),
        Err(RecvTimeoutError::Timeout) => None,
        Err(RecvTimeoutError::Disconnected) => match worker.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(()) => unreachable!("what ends without a panic says what it came to"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_end_is_told() {
        assert_eq!(within(Duration::from_secs(60), || 7), Some(7));
        let (_held, never) = mpsc::channel::<()>();
        assert_eq!(within(Duration::from_millis(10), move || never.recv().is_ok()), None);
    }

    #[test]
    #[should_panic(expected = "as it was told")]
    fn panics_are_passed_on() {
        within(Duration::from_secs(60), || panic!("as it was told"));
    }
}
