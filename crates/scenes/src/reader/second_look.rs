//! What is wrong with an OBJ file, and in which line.

use super::lines::{Lines, show};
use super::polygons::MAX;
use super::position::position;
use crate::error::SceneError;
use std::io::Read;

/// Looks for the first statement that makes no sense, by the rules of the reader.
///
/// # Errors
/// The finding; none if the file is a mesh.
pub fn at(mut lines: Lines<impl Read>) -> Result<(), SceneError> {
    let (mut vertices, mut faces, mut skipped) = (0, 0, 0);
    // A face may name vertices that follow it: its greatest number is held to the end.
    let mut greatest = (0, 0);
    while lines.advance()? {
        let mut words = lines.words(Some(b'#'));
        match words.next() {
            Some(b"v") => {
                vertices += 1;
                let (Some(x), Some(y), Some(z)) = (words.next(), words.next(), words.next()) else {
                    return Err(lines.syntax(format!("vertex {vertices} has less than three coordinates")));
                };
                if vertices > MAX {
                    return Err(lines.too_large("vertices", MAX));
                }
                position(&lines, [x, y, z], vertices)?;
            }
            Some(b"f") => {
                let corners: Vec<&[u8]> = words.collect();
                if corners.len() < 3 {
                    skipped += 1;
                    continue;
                }
                for word in &corners {
                    let index = corner(&lines, word, vertices)?;
                    greatest = greatest.max((index + 1, lines.number()));
                }
                faces += corners.len() - 2;
                if faces > MAX {
                    return Err(lines.too_large("triangles", MAX));
                }
            }
            _ => {}
        }
    }
    let path = lines.path().to_owned();
    let vertices = vertices as u64;
    if faces == 0 {
        return Err(SceneError::NoFaces { path, lines: lines.number(), vertices, skipped });
    }
    let (index, line) = (i64::from(greatest.0), greatest.1);
    if index as u64 > vertices {
        return Err(SceneError::IndexOutOfRange { path, line, index, vertices });
    }
    Ok(())
}

/// The vertex number, from 0, of a corner such as `7`, `7/2`, `7//3` or `-1`.
fn corner(lines: &Lines<impl Read>, word: &[u8], vertices: usize) -> Result<u32, SceneError> {
    let number = word.split(|b| *b == b'/').next().unwrap_or_default();
    let index: i64 = std::str::from_utf8(number)
        .ok()
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| lines.syntax(format!("a face has `{}` for a corner", show(word))))?;
    let absolute = if index < 0 { index.saturating_add(vertices as i64) } else { index - 1 };
    if (0..MAX as i64).contains(&absolute) {
        return Ok(absolute as u32);
    }
    let (path, line) = (lines.path().to_owned(), lines.number());
    Err(SceneError::IndexOutOfRange { path, line, index, vertices: vertices as u64 })
}
