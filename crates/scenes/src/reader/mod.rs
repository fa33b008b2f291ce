//! Readers of mesh files, and where the meshes fetched at set-up are found.
//!
//! OBJ is read by the crate `tobj`, which is given a cleaned text so that files are taken as they are
//! found; the numbers of the vertices and the order of the triangles are the file's.

mod lines;
mod meshes;
mod obj;
mod patches;
mod ply;
mod polygons;
mod position;
mod second_look;

pub use meshes::find;
pub use patches::{is_patches, patches};
pub use polygons::Polygons;

use crate::checksum::hex;
use crate::error::SceneError;
use lines::Lines;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Reads an OBJ or, by the extension `.ply`, an ASCII PLY file.
///
/// Triangles are numbered in file order; polygons are fanned from their first corner, faces of fewer
/// than three corners left out and counted.
///
/// # Errors
/// Unreadable files, statements that make no sense, coordinates that are not finite, faces
/// that name missing vertices, no faces; each with the line or vertex.
pub fn mesh(path: &Path) -> Result<Polygons, SceneError> {
    // What is no file, such as a pipe, has no length, and can be opened once.
    let length = std::fs::metadata(path).map_or(0, |found| found.len());
    check_memory(path, length, accel::available_memory())?;
    parse(path, || File::open(path).map_err(|source| SceneError::Io { path: path.to_owned(), source }))
}

/// [`mesh`] of bytes that are in memory already, as if they were the file's.
///
/// # Errors
/// As [`mesh`].
pub fn mesh_of_bytes(path: &Path, bytes: &[u8]) -> Result<Polygons, SceneError> {
    parse(path, || Ok(bytes))
}

fn parse<R: Read>(path: &Path, open: impl Fn() -> Result<R, SceneError>) -> Result<Polygons, SceneError> {
    let is_ply = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ply"));
    if is_ply { ply::read(Lines::new(path, open()?)) } else { obj::read(path, open) }
}

/// Bytes that reading takes at most for each byte of text: the text, what is parsed, and the mesh.
const EACH: u128 = 3;

fn check_memory(path: &Path, length: u64, available: u128) -> Result<(), SceneError> {
    let bytes = u128::from(length) * EACH;
    if bytes > available {
        return Err(SceneError::Memory { path: path.to_owned(), bytes, available });
    }
    Ok(())
}

/// SHA-256 in hex of a file's bytes.
///
/// # Errors
/// [`SceneError::Io`] names the file.
pub fn file_sha256(path: &Path) -> Result<String, SceneError> {
    let mut hash = Sha256::new();
    let read = File::open(path).and_then(|mut file| io::copy(&mut file, &mut HashWriter(&mut hash)));
    read.map_err(|source| SceneError::Io { path: path.to_owned(), source })?;
    Ok(hex(&hash.finalize()))
}

struct HashWriter<'a>(&'a mut Sha256);

impl io::Write for HashWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_larger_than_memory_are_refused() {
        let path = Path::new("large.obj");
        assert!(check_memory(path, 1000, 3000).is_ok());
        assert!(matches!(check_memory(path, 1001, 3000), Err(SceneError::Memory { bytes: 3003, .. })));
    }
}
