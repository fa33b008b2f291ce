//! `cargo xtask interrupt`: a measurement killed, or out of disk, at a thousand random moments.

use std::process::ExitCode;

use crate::places::Places;
use crate::shell::{cargo, run_to_end};

/// Moments unless told otherwise.
const MOMENTS: u32 = 1000;

/// Reads `[MOMENTS]`.
pub fn moments(args: &[String]) -> Result<u32, String> {
    match args {
        [] => Ok(MOMENTS),
        [text] => text.parse().map_err(|_| format!("`{text}` is no number of moments")),
        _ => Err("interrupt takes a number of moments and nothing else".to_owned()),
    }
}

/// Runs the test of the command line that does it, with so many moments.
pub fn run(places: &Places, moments: u32) -> ExitCode {
    let mut command = cargo();
    command.current_dir(&places.root).args(["test", "-p", "rayscale", "--test", "cli"]);
    command.args(["at_random_moments", "--", "--nocapture"]);
    run_to_end(command.env("RAYSCALE_MOMENTS", moments.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_or_nothing() {
        assert_eq!((moments(&[]), moments(&["7".to_owned()])), (Ok(1000), Ok(7)));
        assert!(moments(&["many".to_owned()]).is_err());
        assert!(moments(&["1".to_owned(), "2".to_owned()]).is_err());
    }
}
