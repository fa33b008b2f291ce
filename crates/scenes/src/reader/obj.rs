//! Wavefront OBJ: vertices and faces. Everything else (normals, texture coordinates, groups,
//! materials and their libraries, lines, points) is passed over.

use super::lines::{Lines, show};
use super::{MOST, fan, position};
use crate::error::SceneError;
use accel::Mesh;

/// Reads the mesh.
pub fn read(mut lines: Lines) -> Result<Mesh, SceneError> {
    let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    // A face may name vertices that follow it: its greatest number is held to the end.
    let mut greatest = (0, 0);
    let mut corners = Vec::new();
    while lines.advance()? {
        let mut words = lines.words(Some(b'#'));
        match words.next() {
            Some(b"v") => {
                let vertex = mesh.positions.len() + 1;
                let (Some(x), Some(y), Some(z)) = (words.next(), words.next(), words.next()) else {
                    return Err(lines.syntax(format!("vertex {vertex} has less than three coordinates")));
                };
                if vertex > MOST {
                    return Err(lines.too_large("vertices", MOST));
                }
                mesh.positions.push(position(&lines, [x, y, z], vertex)?);
            }
            Some(b"f") => {
                corners.clear();
                for word in words {
                    let index = corner(&lines, word, mesh.positions.len())?;
                    greatest = greatest.max((index + 1, lines.number()));
                    corners.push(index);
                }
                fan(&lines, &mut mesh.triangles, &corners)?;
            }
            _ => {}
        }
    }
    let path = lines.path().to_owned();
    let vertices = mesh.positions.len() as u64;
    if mesh.triangles.is_empty() {
        return Err(SceneError::NoFaces { path, lines: lines.number(), vertices });
    }
    let (index, line) = (i64::from(greatest.0), greatest.1);
    if index as u64 > vertices {
        return Err(SceneError::IndexOutOfRange { path, line, index, vertices });
    }
    Ok(mesh)
}

/// The vertex number, from 0, of a corner such as `7`, `7/2`, `7//3` or `-1`.
fn corner(lines: &Lines, word: &[u8], vertices: usize) -> Result<u32, SceneError> {
    let number = word.split(|b| *b == b'/').next().unwrap_or_default();
    let index: i64 = std::str::from_utf8(number)
        .ok()
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| lines.syntax(format!("a face has `{}` for a corner", show(word))))?;
    let absolute = if index < 0 { index.saturating_add(vertices as i64) } else { index - 1 };
    if (0..MOST as i64).contains(&absolute) {
        return Ok(absolute as u32);
    }
    let (path, line) = (lines.path().to_owned(), lines.number());
    Err(SceneError::IndexOutOfRange { path, line, index, vertices: vertices as u64 })
}
