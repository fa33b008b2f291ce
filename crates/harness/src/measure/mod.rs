//! Measuring: in passes over the ray sets of a scene; in each builds first, then rays, round by round over all
//! structures.
//!
//! Build times, trace times and memory come from separate runs. The first build is
//! watched for memory and not timed; the first trace warms up, is compared with brute force
//! and not timed. After every timed trace all answers are compared with those of the first,
//! outside of the timed section.

mod build;
mod deadline;
mod entry;
mod failure;
mod job;
mod memory;
mod options;
mod resume;
mod run;
mod scene;
mod session;
#[cfg(test)]
mod tests;
mod trace;

pub use deadline::Deadline;
pub use failure::Failure;
pub use job::Job;
pub use memory::{RESOLUTIONS, memory_rows};
pub use options::Options;
pub use resume::{ResumeError, resume};
pub use run::{SessionError, run};
pub use scene::measure;
pub use session::{Session, begin};
