//! A summary of a record between two markers of a text.

use super::markdown::ranked;
use crate::table::{code, escape};
use harness::record::Record;
use std::fmt::Write;

/// Begins the part that is written anew.
pub const BEGIN: &str = "<!-- rayscale: begin -->";
/// Ends it.
pub const END: &str = "<!-- rayscale: end -->";

/// Why a text takes no summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SpliceError {
    /// The markers are not there once each and in order.
    #[error("there must be one line `{BEGIN}` and behind it one line `{END}`")]
    Markers,
    /// What is to be put in holds a marker: the next splice would cut there.
    #[error("the record's summary holds one of the lines `{BEGIN}` and `{END}` itself")]
    Inside,
}

/// The text with what lies between the markers replaced.
///
/// # Errors
/// If the markers are not there once each and in order, or `between` holds one.
pub fn splice(text: &str, between: &str) -> Result<String, SpliceError> {
    if [BEGIN, END].iter().any(|marker| between.contains(marker)) {
        return Err(SpliceError::Inside);
    }
    let (before, rest) = text.split_once(BEGIN).ok_or(SpliceError::Markers)?;
    let (old, after) = rest.split_once(END).ok_or(SpliceError::Markers)?;
    if [old, after].iter().any(|part| part.contains(BEGIN)) || after.contains(END) || before.contains(END) {
        return Err(SpliceError::Markers);
    }
    Ok(format!("{before}{BEGIN}\n{}\n{END}{after}", between.trim()))
}

/// What a README says of a record, and the commands that made it.
pub fn summary(record: &Record, splicing: &str) -> String {
    let mut out = String::new();
    let m = &record.machine;
    let _ = writeln!(
        out,
        "Measured by {} on {} ({}), {} scenes; written here by {}.\n",
        code(&record.command),
        escape(&m.cpu),
        escape(&m.isa),
        record.scenes.len(),
        code(splicing)
    );
    for (title, raster) in [("Rasters", true), ("Lists of rays", false)] {
        if let Some((line, table)) = ranked(record, raster) {
            let _ = writeln!(out, "**{title}**: {line}\n\n{}", table.markdown());
        }
    }
    out
}
