//! Readers of mesh files, and where the meshes fetched at set-up are found.
//!
//! The readers are the suite's own because what they must keep is what general readers drop:
//! the file's vertex numbering, line numbers in errors, the order of the triangles. A test
//! holds the OBJ reader against the crate `tobj`.

mod lines;
mod meshes;
mod obj;
mod ply;

pub use meshes::find;

use crate::checksum::hex;
use crate::error::SceneError;
use accel::{Mesh, Vec3};
use lines::Lines;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io;
use std::path::Path;

/// Reads an OBJ or, by the extension `.ply`, an ASCII PLY file.
///
/// Triangles are numbered in file order; polygons are fanned from their first corner.
///
/// # Errors
/// Unreadable files, statements that make no sense, coordinates that are not finite, faces
/// that name missing vertices, no faces; each with the line or vertex.
pub fn mesh(path: &Path) -> Result<Mesh, SceneError> {
    let file = File::open(path).map_err(|source| SceneError::Io { path: path.to_owned(), source })?;
    let lines = Lines::new(path, file);
    let is_ply = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ply"));
    if is_ply { ply::read(lines) } else { obj::read(lines) }
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

/// The most vertices or triangles of a mesh: one number is left over to mean "none".
const MOST: usize = u32::MAX as usize - 1;

/// A coordinate triple from three words of vertex number `vertex` (from 1).
fn position(lines: &Lines, words: [&[u8]; 3], vertex: usize) -> Result<Vec3, SceneError> {
    let mut p = [0.0; 3];
    for (x, word) in p.iter_mut().zip(words) {
        let text = lines::show(word);
        *x = std::str::from_utf8(word)
            .ok()
            .and_then(|word| word.parse::<f32>().ok())
            .ok_or_else(|| lines.syntax(format!("vertex {vertex} has `{text}` for a coordinate")))?;
        if !x.is_finite() {
            let (path, line) = (lines.path().to_owned(), Some(lines.number()));
            return Err(SceneError::NotFinite { path, line, vertex: vertex as u64, value: text });
        }
    }
    Ok(Vec3::from_array(p))
}

/// Adds the fan of a polygon with `corners`.
fn fan(lines: &Lines, triangles: &mut Vec<[u32; 3]>, corners: &[u32]) -> Result<(), SceneError> {
    if corners.len() < 3 {
        return Err(lines.syntax(format!("a face needs three corners, this one has {}", corners.len())));
    }
    if triangles.len() + corners.len() > MOST {
        return Err(lines.too_large("triangles", MOST));
    }
    triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
    Ok(())
}
