//! Work shared by threads: [rayon](https://docs.rs/rayon) where the feature `parallel` is on, and a serial
//! stand-in of the same names where it is off, so that code is written once.

mod chunks;
#[cfg(feature = "parallel")]
mod rayon;
#[cfg(any(not(feature = "parallel"), test))]
pub mod serial;

pub use chunks::{for_each_chunk, map_chunks, map_tasks};

#[cfg(feature = "parallel")]
pub use self::rayon::{extend, join, prelude, repeat_n, threads};
#[cfg(not(feature = "parallel"))]
pub use self::serial::{extend, join, prelude, repeat_n, threads};
