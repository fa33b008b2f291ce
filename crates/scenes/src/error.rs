//! What can be wrong with a scene.

use std::path::PathBuf;

/// Why a scene can't be had. Messages say what is wrong and where; [`SceneError::hint`] says
/// what to do.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// No scene of this name.
    #[error("there is no scene `{id}`{}", suggest(.near))]
    Unknown {
        /// What was asked for.
        id: String,
        /// Known scenes with similar names, nearest first.
        near: Vec<String>,
    },
    /// A scene whose mesh is not on this machine.
    #[error("scene `{id}` is unavailable: {reason}")]
    Unavailable {
        /// The scene.
        id: String,
        /// Why.
        reason: String,
        /// The command that may help.
        hint: &'static str,
    },
    /// A definition or a modifier that doesn't say a scene.
    #[error("scene definition {origin}: {reason}")]
    Definition {
        /// The file or id that holds it.
        origin: String,
        /// What is wrong.
        reason: String,
    },
    /// A file that can't be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A statement that makes no sense.
    #[error("{}, line {line}: {reason}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: u64,
        /// What is wrong.
        reason: String,
    },
    /// NaN or an infinite coordinate.
    #[error("{}{}: vertex {vertex} has the coordinate {value}, which is not finite in single precision",
        path.display(), line.map_or(String::new(), |n| format!(", line {n}")))]
    NotFinite {
        /// The file, or the scene's id for a generated scene.
        path: PathBuf,
        /// Counted from 1, where the scene comes from a file.
        line: Option<u64>,
        /// Counted from 1, as OBJ does.
        vertex: u64,
        /// The coordinate as written.
        value: String,
    },
    /// A face that names a vertex which the file doesn't have.
    #[error("{}, line {line}: the face names vertex {index}, but there are {vertices} vertices", path.display())]
    IndexOutOfRange {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: u64,
        /// As written.
        index: i64,
        /// How many vertices there are for the face to name.
        vertices: u64,
    },
    /// A mesh without a face.
    #[error("{}: no faces in {lines} lines{}", path.display(), beside(*.vertices, *.skipped))]
    NoFaces {
        /// The file.
        path: PathBuf,
        /// Lines read.
        lines: u64,
        /// Vertices seen.
        vertices: u64,
        /// Faces of fewer than three corners.
        skipped: u64,
    },
    /// A file that the reader refuses for a reason without a place.
    #[error("{}: {reason}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// Coordinates that single precision can hold but not reckon with.
    #[error("{}: {reason}", path.display())]
    OutOfScale {
        /// The file, or the scene's id.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A mesh that memory does not suffice for.
    #[error("{}: reading it takes about {bytes} bytes, more than the {available} there are", path.display())]
    Memory {
        /// The file.
        path: PathBuf,
        /// What it would take.
        bytes: u128,
        /// What there is.
        available: u128,
    },
    /// More vertices or triangles than 32-bit numbers name.
    #[error("{}: more than {most} {what}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Vertices, triangles, …
        what: &'static str,
        /// The limit.
        most: u64,
    },
}

impl SceneError {
    /// What to do about it, where there is something to do.
    pub fn hint(&self) -> Option<&'static str> {
        match self {
            Self::Unknown { .. } => Some("`rayscale scenes` lists what there is"),
            Self::Unavailable { hint, .. } => Some(hint),
            _ => None,
        }
    }

    /// Whether the scene is merely not on this machine, so that a run goes on without it.
    pub fn is_unavailable(&self) -> bool {
        matches!(self, Self::Unavailable { .. })
    }
}

/// What there is in place of faces.
fn beside(vertices: u64, skipped: u64) -> String {
    match (vertices, skipped) {
        (_, 1..) => format!(" but {skipped} of fewer than three corners"),
        (0, 0) => ", nor vertices: is this a mesh?".to_owned(),
        _ => String::new(),
    }
}

fn suggest(near: &[String]) -> String {
    match near {
        [] => String::new(),
        near => format!("; near: {}", near.iter().map(|id| format!("`{id}`")).collect::<Vec<_>>().join(", ")),
    }
}
