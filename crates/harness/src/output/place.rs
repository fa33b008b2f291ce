//! What a path that is to be written names.

use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// What a path names, links followed.
pub(super) enum Place {
    /// No file: a device, a pipe, or what is open already.
    Direct(PathBuf),
    /// A file, or nothing yet.
    File(Regular),
}

/// A file that is to be replaced or made.
pub(super) struct Regular {
    pub path: PathBuf,
    before: Option<Metadata>,
}

/// Where names stand for what is open: a file that is renamed would not be it. Elsewhere below `/dev`, in `/dev/shm` for
/// instance, there are files as well.
const OPEN: [&str; 5] = ["/dev/fd", "/dev/stdin", "/dev/stdout", "/dev/stderr", "/proc"];

/// Links that are followed one after another, as systems have it.
const MAX_LINKS: usize = 40;

impl Place {
    pub fn of(path: &Path) -> io::Result<Self> {
        if OPEN.iter().any(|names| path.starts_with(names)) {
            return Ok(Self::Direct(path.to_owned()));
        }
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(found) if found.is_file() => {
                Ok(Self::File(Regular { path: fs::canonicalize(path)?, before: Some(found) }))
            }
            Ok(_) => Ok(Self::Direct(path.to_owned())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Ok(Self::File(Regular { path: end_of_links(path)?, before: None }))
            }
            Err(error) => Err(error),
        }
    }
}

/// Where links lead that end at nothing.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&path) {
            Ok(to) => path = path.parent().map_or(to.clone(), |folder| folder.join(&to)),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many links"))
}

impl Regular {
    pub fn is_there(&self) -> bool {
        self.before.is_some()
    }

    fn folder(&self) -> &Path {
        let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new("."))
    }

    /// A new file in the same folder, under a name that nobody could foresee, with the mode that the file has or will have.
    pub fn beside(&self) -> io::Result<NamedTempFile> {
        let mut builder = Builder::new();
        // A name of its own, as the file's with more to it may be longer than names can be.
        builder.prefix(".rayscale-").suffix(".part");
        // Readable by whom the user lets read new files.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let part = builder.tempfile_in(self.folder())?;
        if let Some(before) = &self.before {
            part.as_file().set_permissions(before.permissions())?;
        }
        Ok(part)
    }

    /// Makes the new name last through a failure of power, where the system has a way.
    pub fn sync_folder(&self) {
        // The file is there; that some file systems can't promise more is no reason to fail.
        let _ = File::open(self.folder()).and_then(|folder| folder.sync_all());
    }
}
