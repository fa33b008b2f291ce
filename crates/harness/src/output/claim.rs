//! One writer at a time.

use super::place::Place;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// The right to write a file again and again; nobody else that asks gets it meanwhile.
///
/// A file beside it is locked, which the system undoes however the program ends.
#[derive(Debug)]
pub struct Claim {
    /// None where there is nothing to be claimed: devices take what they get.
    _file: Option<Locked>,
}

/// Why a file can't be claimed.
#[derive(Debug, thiserror::Error)]
pub enum ClaimError {
    /// Another process writes it.
    #[error("another run is writing it")]
    Taken,
    /// The file system refuses.
    #[error(transparent)]
    Io(#[from] io::Error),
}

#[derive(Debug)]
struct Locked {
    path: PathBuf,
    file: File,
}

impl Claim {
    /// Claims a file, which need not be there yet.
    ///
    /// # Errors
    /// [`ClaimError::Taken`], and errors of the file system.
    pub fn of(path: &Path) -> Result<Self, ClaimError> {
        let Place::File(regular) = Place::of(path)? else { return Ok(Self { _file: None }) };
        let mut name = OsString::from(".");
        name.push(regular.path.file_name().unwrap_or_default());
        name.push(".lock");
        let path = regular.path.with_file_name(name);
        loop {
            let file = File::options().create(true).truncate(false).write(true).open(&path)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(ClaimError::Taken),
                // Some network file systems lock nothing.
                Err(TryLockError::Error(_)) => return Ok(Self { _file: None }),
            }
            // Who had it before may have removed it in between.
            if is_same(&file, &path)? {
                return Ok(Self { _file: Some(Locked { path, file }) });
            }
        }
    }
}

#[cfg(unix)]
fn is_same(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let here = file.metadata()?;
    Ok(fs::metadata(path).is_ok_and(|there| (there.dev(), there.ino()) == (here.dev(), here.ino())))
}

#[cfg(not(unix))]
fn is_same(_: &File, path: &Path) -> io::Result<bool> {
    Ok(path.exists())
}

impl Drop for Locked {
    fn drop(&mut self) {
        // Removed while it is locked; whoever opened it before looks whether it is still there.
        let _ = fs::remove_file(&self.path);
        let _ = self.file.unlock();
    }
}
