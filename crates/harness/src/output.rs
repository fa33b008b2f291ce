//! Files written whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes `path` through `write`: to a temporary file beside it, renamed at the end. Whatever
/// was at `path` stays untouched until then, and for good if anything fails.
///
/// # Errors
/// What `write` answers, and errors of the file system.
pub fn write_whole<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part = Path::new(&name);
    let written = File::create(part).map_err(E::from).and_then(|file| {
        let mut out = BufWriter::new(file);
        write(&mut out)?;
        out.flush()?;
        out.get_ref().sync_all()?;
        Ok(fs::rename(part, path)?)
    });
    if written.is_err() {
        // The first error is what matters; there may be nothing to remove.
        let _ = fs::remove_file(part);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

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
