//! The current rayon pool.

pub use ::rayon::iter::repeat_n;
pub use ::rayon::{join, prelude};
use prelude::*;

/// Appends items, written by all threads; nothing is allocated where there is room for all.
pub fn extend<T: Send>(all: &mut Vec<T>, items: impl IndexedParallelIterator<Item = T>) {
    all.par_extend(items);
}

/// How many threads the work is shared by: those of the current rayon pool.
pub fn threads() -> usize {
    ::rayon::current_num_threads()
}
