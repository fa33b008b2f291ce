//! Files written whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// Writes `path` through `write`: to a temporary file beside it, renamed at the end. Whatever
/// was at `path` stays untouched until then, and for good if anything fails.
///
/// # Errors
/// What `write` answers, and errors of the file system.
pub fn write_whole<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), E> {
    let part = beside(path)?;
    let mut out = BufWriter::new(part.as_file());
    write(&mut out)?;
    out.flush()?;
    drop(out);
    part.as_file().sync_all()?;
    part.persist(path).map_err(|error| E::from(error.error))?;
    Ok(())
}

fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let mut builder = Builder::new();
    builder.prefix(path.file_name().unwrap_or_default()).suffix(".part");
    // Readable by whom the user lets read new files, as the file itself will be.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder.unwrap_or(Path::new(".")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_failure_leaves_what_was_there() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("out.csv");
        write_whole(&path, |out| writeln!(out, "first"))?;
        let failed = write_whole(&path, |out| {
            writeln!(out, "second")?;
            Err(io::Error::other("no more"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "no more");
        assert_eq!(fs::read_to_string(&path)?, "first\n");
        assert_eq!(fs::read_dir(folder.path())?.count(), 1, "the temporary file is gone");
        Ok(())
    }
}
