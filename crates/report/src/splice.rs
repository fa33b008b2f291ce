//! A summary of a record between two markers of a text.

use super::markdown::ranked;
use harness::record::Record;
use std::fmt::Write;

/// Begins the part that is written anew.
pub const BEGIN: &str = "<!-- rayscale: begin -->";
/// Ends it.
pub const END: &str = "<!-- rayscale: end -->";

/// Why a text takes no summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there must be one line `{BEGIN}` and behind it one line `{END}`")]
pub struct SpliceError;

/// The text with what lies between the markers replaced.
///
/// # Errors
/// If the markers are not there once each and in order.
pub fn splice(text: &str, between: &str) -> Result<String, SpliceError> {
    let (before, rest) = text.split_once(BEGIN).ok_or(SpliceError)?;
    let (old, after) = rest.split_once(END).ok_or(SpliceError)?;
    if [old, after].iter().any(|part| part.contains(BEGIN)) || after.contains(END) || before.contains(END) {
        return Err(SpliceError);
    }
    Ok(format!("{before}{BEGIN}\n{}\n{END}{after}", between.trim()))
}

/// What a README says of a record, and the commands that made it.
pub fn summary(record: &Record, splicing: &str) -> String {
    let mut out = String::new();
    let m = &record.machine;
    let _ = writeln!(
        out,
        "Measured by `{}` on {} ({}), {} scenes; written here by `{splicing}`.\n",
        record.command,
        m.cpu,
        m.isa,
        record.scenes.len()
    );
    for (title, raster) in [("Rasters", true), ("Lists of rays", false)] {
        if let Some((line, table)) = ranked(record, raster) {
            let _ = writeln!(out, "**{title}**: {line}\n\n{}", table.markdown());
        }
    }
    out
}
