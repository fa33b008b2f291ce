//! A structure's panic is a result like any other.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What panicked, and with which words.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} panicked: {message}")]
pub struct Panicked {
    /// What was being done.
    pub what: &'static str,
    /// The panic's message.
    pub message: String,
}

/// Does `work`.
///
/// # Errors
/// If it panics.
pub fn guard<T>(what: &'static str, work: impl FnOnce() -> T) -> Result<T, Panicked> {
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|panic| Panicked { what, message: message(panic.as_ref()).to_owned() })
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message")
}
