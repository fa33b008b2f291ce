//! The current rayon pool.

pub use ::rayon::iter::repeat_n;
pub use ::rayon::{join, prelude};

/// How many threads the work is shared by: those of the current rayon pool.
pub fn threads() -> usize {
    ::rayon::current_num_threads()
}
