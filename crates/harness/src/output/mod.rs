//! Files written whole or not at all.

mod claim;
mod place;

pub use claim::{Claim, ClaimError};

use place::Place;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes `path` through `write`: to a temporary file beside it, renamed at the end. Whatever
/// was at `path` stays untouched until then, and for good if anything fails.
///
/// A link is followed, and a file that is replaced keeps its mode. What is no file, such as a device or a pipe, is
/// written to as it is.
///
/// # Errors
/// What `write` answers, and errors of the file system.
pub fn write_whole<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), E> {
    let file = match Place::of(path)? {
        Place::Direct(path) => {
            let file = File::options().write(true).open(path)?;
            return through(&file, write);
        }
        Place::File(file) => file,
    };
    let part = file.beside()?;
    through(part.as_file(), write)?;
    part.as_file().sync_all()?;
    part.persist(&file.path).map_err(|error| E::from(error.error))?;
    file.sync_folder();
    Ok(())
}

fn through<E: From<io::Error>>(
    file: &File,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), E> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()?;
    Ok(())
}

/// Whether [`write_whole`] would be let write there, as far as can be told before: so that nobody works for an hour and then
/// learns that the result has no place.
///
/// # Errors
/// Errors of the file system.
pub fn check(path: &Path) -> io::Result<()> {
    match Place::of(path)? {
        // A pipe whose other end isn't open yet would be waited for.
        Place::Direct(_) => Ok(()),
        Place::File(file) => {
            if file.is_there() {
                File::options().append(true).open(&file.path)?;
            }
            file.beside().map(drop)
        }
    }
}

#[cfg(test)]
mod tests;
