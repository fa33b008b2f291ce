//! A summary of a record between two markers of a text.

use super::markdown::ranked;
use crate::table::{code, escape};
use harness::record::Record;
use std::fmt::Write;

/// Begins the part that is written anew.
pub const BEGIN: &str = "<!-- rayscale: begin -->";
/// Ends it.
pub const END: &str = "<!-- rayscale: end -->";

/// The same for the summary of a trade.
pub const TRADE: [&str; 2] = ["<!-- rayscale trade: begin -->", "<!-- rayscale trade: end -->"];

/// The same for the table of extremes.
pub const EXTREMES: [&str; 2] = ["<!-- rayscale extremes: begin -->", "<!-- rayscale extremes: end -->"];

/// Why a text takes no summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SpliceError {
    /// The markers are not there once each and in order.
    #[error("there must be one line `{0}` and behind it one line `{1}`")]
    Markers(&'static str, &'static str),
    /// What is to be put in holds a marker: the next splice would cut there.
    #[error("the record's summary holds one of the lines `{0}` and `{1}` itself")]
    Inside(&'static str, &'static str),
}

/// The text with what lies between the markers replaced.
///
/// # Errors
/// If the markers are not there once each and in order, or `between` holds one.
pub fn splice(text: &str, between: &str) -> Result<String, SpliceError> {
    splice_at(text, between, [BEGIN, END])
}

/// The same with other markers.
///
/// # Errors
/// As [`splice`].
pub fn splice_at(text: &str, between: &str, [begin, end]: [&'static str; 2]) -> Result<String, SpliceError> {
    let markers = SpliceError::Markers(begin, end);
    if [begin, end].iter().any(|marker| between.contains(marker)) {
        return Err(SpliceError::Inside(begin, end));
    }
    let (before, rest) = text.split_once(begin).ok_or(markers)?;
    let (old, after) = rest.split_once(end).ok_or(markers)?;
    if [old, after].iter().any(|part| part.contains(begin)) || after.contains(end) || before.contains(end) {
        return Err(markers);
    }
    Ok(format!("{before}{begin}\n{}\n{end}{after}", between.trim()))
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
