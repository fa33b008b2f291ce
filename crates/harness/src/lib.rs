//! The harness: ray sets, checks, measurements, records, and what is read off records.
//!
//! A measurement goes through the modules in this order. [`workload`] makes the rays of a scene; [`registry`] names
//! the structures; [`auto`] decides the kernels that are left to the suite; [`check`] holds answers to brute force and
//! to the oracle; [`measure`] takes samples; [`record`] keeps all that was found. [`grouped`], [`changes`] and
//! [`recommend`] rank and compare what records hold. [`sweeps`] look at answers instead of times.

#![forbid(unsafe_code)]

pub use judge;

pub mod answers;
pub mod auto;
pub mod changes;
pub mod check;
pub mod clock;
pub mod front;
pub mod grouped;
pub mod guard;
pub mod machine;
pub mod measure;
pub mod output;
pub mod progress;
pub mod recommend;
pub mod record;
pub mod registry;
pub mod stats;
pub mod sweeps;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
pub mod units;
pub mod workload;
