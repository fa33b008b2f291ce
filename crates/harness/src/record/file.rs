//! Records as files.

use super::{FORMAT, Record};
use crate::output::write_whole;
use serde::de::DeserializeOwned;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A kind of record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// What they are records of.
    pub of: &'static str,
    /// What to name where such a record is asked for.
    pub example: &'static str,
    /// The form of today's.
    pub format: u32,
    /// The form of those that say none, if there were such.
    pub unsaid: Option<u32>,
}

/// Records of measurements.
const MEASURED: Kind = Kind {
    of: "rayscale",
    example: "a record.json that `rayscale measure` or `rayscale compare` wrote",
    format: FORMAT,
    unsaid: None,
};

/// Why there is no record to be had from a file.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file can't be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file holds no record.
    #[error("{}, line {}, column {}: not a record of {}: {source}", path.display(), source.line(), source.column(), kind.of)]
    Syntax {
        /// The file.
        path: PathBuf,
        /// What it should be.
        kind: Kind,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// A record of a later form.
    #[error("{}: a record of format {found}; this program reads up to format {}", path.display(), kind.format)]
    Format {
        /// The file.
        path: PathBuf,
        /// What it should be.
        kind: Kind,
        /// Its format.
        found: u64,
    },
}

/// Reads a record.
///
/// # Errors
/// Files that can't be read, are no record, or are of a later form.
pub fn read(path: &Path) -> Result<Record, RecordError> {
    read_kind(path, MEASURED)
}

/// [`read`] of a text that is in memory already, as if it were the file's.
///
/// # Errors
/// As [`read`].
pub fn from_text(path: &Path, text: &str) -> Result<Record, RecordError> {
    parse(path, text, MEASURED)
}

/// The text that [`write()`] makes of a record.
///
/// # Errors
/// What can't be JSON.
pub fn to_text(record: &Record) -> serde_json::Result<String> {
    let mut text = serde_json::to_string_pretty(record)?;
    text.push('\n');
    Ok(text)
}

/// Reads a record of any kind.
///
/// # Errors
/// As [`read`].
pub fn read_kind<T: DeserializeOwned>(path: &Path, kind: Kind) -> Result<T, RecordError> {
    let text =
        std::fs::read_to_string(path).map_err(|source| RecordError::Io { path: path.to_owned(), source })?;
    parse(path, &text, kind)
}

fn parse<T: DeserializeOwned>(path: &Path, text: &str, kind: Kind) -> Result<T, RecordError> {
    let syntax = |source| RecordError::Syntax { path: path.to_owned(), kind, source };
    // The format comes first: a later record may lack what this one needs.
    #[derive(serde::Deserialize)]
    struct Head {
        format: Option<u64>,
    }
    let Head { format } = serde_json::from_str(text).map_err(syntax)?;
    let Some(format) = format.or(kind.unsaid.map(u64::from)) else {
        return Err(syntax(serde::de::Error::missing_field("format")));
    };
    if format > u64::from(kind.format) {
        return Err(RecordError::Format { path: path.to_owned(), kind, found: format });
    }
    serde_json::from_str(text).map_err(syntax)
}

/// Writes a record whole or not at all.
///
/// # Errors
/// Errors of the file system.
pub fn write(path: &Path, record: &Record) -> Result<(), RecordError> {
    let written: Result<(), io::Error> = write_whole(path, |out| out.write_all(to_text(record)?.as_bytes()));
    written.map_err(|source| RecordError::Io { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn records_come_back_as_they_were() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.json");
        let record = testing::record();
        write(&path, &record).unwrap();
        assert_eq!(read(&path).unwrap(), record);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_is_no_record_is_said_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.json");
        let error = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read(&path).unwrap_err()
        };
        assert!(matches!(error("{\"format\": 99}"), RecordError::Format { found: 99, .. }));
        let message = error("{\"format\": 1,\n \"cells\": 3}").to_string();
        assert!(message.contains("line 2") && message.contains("not a record"), "{message}");
        assert!(matches!(error("PNG"), RecordError::Syntax { .. }));
        assert!(matches!(read(&folder.path().join("none")), Err(RecordError::Io { .. })));
        let folder_missing = folder.path().join("none").join("record.json");
        assert!(matches!(write(&folder_missing, &testing::record()), Err(RecordError::Io { .. })));
    }
}
