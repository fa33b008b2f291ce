//! What can go wrong at the command line: what, where, and what to do about it.

use accel::BuildError;
use harness::measure::{ResumeError, SessionError};
use harness::record::RecordError;
use harness::registry::RegistryError;
use paper::PaperError;
use scenes::SceneError;
use scenes::near::near;
use scenes::rays::RaysError;
use std::fmt::Display;
use std::io;
use std::path::Path;

/// Bad usage or input. All end with exit code 2.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A name that nothing has.
    #[error("there is no {kind} `{name}`")]
    Unknown {
        /// What was named: a structure, a kernel, …
        kind: &'static str,
        /// The name.
        name: String,
        /// Names that resemble it.
        near: Vec<String>,
        /// All names.
        all: Vec<String>,
    },
    /// Input or options that can't be used.
    #[error("{what}")]
    Usage {
        /// What is wrong, and where.
        what: String,
        /// What to do.
        todo: String,
    },
    /// A file or stream that can't be read or written.
    #[error("{place}: {source}")]
    Io {
        /// Which.
        place: String,
        /// The system's reason.
        source: io::Error,
    },
    /// A structure that can't be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A scene that can't be had.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A structure that can't be had.
    #[error(transparent)]
    Registry(#[from] RegistryError),
    /// Rays that can't be made.
    #[error(transparent)]
    Rays(#[from] RaysError),
    /// A record that can't be gone on with.
    #[error("this record can't be gone on with: {0}")]
    Resume(#[from] ResumeError),
    /// A record that can't be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
}

impl From<PaperError> for Error {
    fn from(error: PaperError) -> Self {
        match error {
            PaperError::Scene(error) => error.into(),
            PaperError::Build(error) => error.into(),
        }
    }
}

impl From<model::StudyError> for Error {
    fn from(error: model::StudyError) -> Self {
        match error {
            model::StudyError::Scene(error) => error.into(),
            model::StudyError::Registry(error) => error.into(),
            error @ model::StudyError::NoSolids(..) => {
                Self::usage(error.to_string(), "name a scene of solids, such as teapot-patches or balls-true")
            }
            error @ model::StudyError::Build(_) => Self::usage(error.to_string(), "choose another structure"),
        }
    }
}

impl From<rayon::ThreadPoolBuildError> for Error {
    fn from(error: rayon::ThreadPoolBuildError) -> Self {
        Self::usage(error.to_string(), "let the program have more threads")
    }
}

impl From<SessionError> for Error {
    fn from(error: SessionError) -> Self {
        match error {
            SessionError::Scene(error) => error.into(),
            SessionError::Resume(error) => error.into(),
        }
    }
}

impl Error {
    /// Bad usage or input.
    pub fn usage(what: impl Into<String>, todo: impl Into<String>) -> Self {
        Self::Usage { what: what.into(), todo: todo.into() }
    }

    /// A file or stream that can't be read or written.
    pub fn io(place: impl Display, source: io::Error) -> Self {
        Self::Io { place: place.to_string(), source }
    }

    /// A name that is none of `names`.
    pub fn unknown<'n>(
        kind: &'static str,
        name: &str,
        names: impl IntoIterator<Item = &'n str> + Clone,
    ) -> Self {
        let all = names.clone().into_iter().map(str::to_owned).collect();
        Self::Unknown { kind, name: name.to_owned(), near: near(name, names), all }
    }

    /// What to do about it, where there is something to do.
    pub fn todo(&self) -> Option<String> {
        match self {
            Self::Unknown { near, all, .. } if near.is_empty() => {
                Some(format!("choose one of {}", list(all)))
            }
            Self::Unknown { near, .. } => Some(format!("did you mean {}?", list(near))),
            Self::Usage { todo, .. } => Some(todo.clone()),
            Self::Build(BuildError::Unsupported { .. }) => Some("choose another structure".into()),
            Self::Scene(SceneError::Io { .. }) => Some("check the path and who may read or write it".into()),
            Self::Scene(error) => {
                Some(error.hint().unwrap_or("correct the scene, or export it again").into())
            }
            Self::Registry(RegistryError::Unknown { .. }) => {
                Some("`rayscale structures` lists what there is".into())
            }
            Self::Registry(RegistryError::Absent { .. }) => {
                Some("run `cargo xtask setup`, then build again".into())
            }
            Self::Registry(_) => Some("`rayscale structures` lists the settings of each structure".into()),
            Self::Resume(_) => Some(
                "give --out another name to begin a new record, or leave out --resume to replace this one"
                    .into(),
            ),
            Self::Record(RecordError::Io { source, .. }) | Self::Io { source, .. } => {
                let by_path =
                    matches!(source.kind(), io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied);
                by_path.then(|| "check the path and who may read or write it".into())
            }
            Self::Record(RecordError::Syntax { kind, .. }) => Some(format!("name {}", kind.example)),
            Self::Record(_) | Self::Rays(_) | Self::Build(_) => None,
        }
    }

    /// Whether the reader of the output has gone away, which is no fault.
    pub fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::Io { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Says before work begins that its result would have no place.
///
/// # Errors
/// [`Error::Io`] names it.
pub fn check_place(path: &Path) -> Result<(), Error> {
    harness::output::check(path).map_err(|error| Error::io(path.display(), error))
}

fn list(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
