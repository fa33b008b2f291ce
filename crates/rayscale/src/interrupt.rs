//! Ctrl-C: the first asks for an end, the second ends at once.

use crate::console::Console;
use crate::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code after an interruption: 128 and the number of SIGINT, as shells have it.
pub const EXIT_CODE: u8 = 130;

/// A flag that is set from the first Ctrl-C on (and by SIGTERM and SIGHUP).
///
/// # Errors
/// Where the system lets nobody listen.
pub fn flag(console: &Console) -> Result<Arc<AtomicBool>, Error> {
    let flag = Arc::new(AtomicBool::new(false));
    let (seen, quiet) = (flag.clone(), console.quiet());
    let listening = ctrlc::set_handler(move || {
        if seen.swap(true, Ordering::Relaxed) {
            std::process::exit(EXIT_CODE.into());
        }
        if !quiet {
            eprintln!("\nstopping after this sample; once more stops at once");
        }
    });
    match listening {
        Ok(()) => Ok(flag),
        Err(ctrlc::Error::System(error)) => Err(Error::io("Ctrl-C", error)),
        Err(error) => Err(Error::io("Ctrl-C", std::io::Error::other(error))),
    }
}
