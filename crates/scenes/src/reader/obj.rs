//! Wavefront OBJ: vertices and faces, read by `tobj`. Everything else (normals, texture coordinates,
//! groups, materials and their libraries, lines, points) is passed over.

use super::lines::Lines;
use super::polygons::{MAX, Polygons};
use super::second_look;
use crate::error::SceneError;
use accel::{Mesh, Vec3};
use std::io::Read;
use std::path::Path;

/// Reads the mesh. `tobj` tells neither the line of an error nor the text: they are looked for in a
/// second pass over the file, which is opened again only after a failure.
pub fn read<R: Read>(path: &Path, open: impl Fn() -> Result<R, SceneError>) -> Result<Polygons, SceneError> {
    let (statements, skipped) = essence(Lines::new(path, open()?))?;
    // Polygons are fanned here, as triangulated ones can't be told from the marks.
    let options = tobj::LoadOptions::default();
    let no_materials = |_: &Path| Ok(Default::default());
    let loaded = tobj::load_obj_buf(&mut statements.as_slice(), &options, no_materials);
    let failure = |reason: String| match open().and_then(|again| second_look::at(Lines::new(path, again))) {
        Ok(()) => SceneError::Mesh { path: path.to_owned(), reason },
        Err(found) => found,
    };
    let (models, _) = loaded.map_err(|error| failure(error.to_string()))?;
    let mut polygons = Polygons { mesh: Mesh { positions: Vec::new(), triangles: Vec::new() }, skipped };
    for model in &models {
        add(&model.mesh, &mut polygons).map_err(failure)?;
    }
    if polygons.mesh.triangles.is_empty() || !polygons.mesh.positions.iter().all(|p| p.is_finite()) {
        return Err(failure("it has no faces, or coordinates that are not finite".into()));
    }
    Ok(polygons)
}

/// The statements that make the mesh, and how many faces have fewer than three corners.
///
/// What a file may hold besides is left out, because `tobj` would refuse it or misread it: a byte
/// order mark, names that are not UTF-8, comments behind a statement, a fourth coordinate, polylines
/// (which it takes for faces) and groups (within each of which it numbers the vertices anew). A point
/// after each vertex has it number them as the file does.
fn essence(mut lines: Lines<impl Read>) -> Result<(Vec<u8>, u64), SceneError> {
    let (mut out, mut skipped) = (Vec::new(), 0);
    while lines.advance()? {
        let mut words = lines.words(Some(b'#'));
        match words.next() {
            Some(b"v") => {
                put(&mut out, b"v", words.take(3));
                put(&mut out, b"f", [&b"-1"[..]]);
            }
            Some(b"f") => {
                let start = out.len();
                let corners = put(&mut out, b"f", words.map(vertex));
                if corners < 3 {
                    out.truncate(start);
                    skipped += 1;
                }
            }
            _ => {}
        }
    }
    Ok((out, skipped))
}

/// Writes a statement and says how many words follow its name.
fn put<'w>(out: &mut Vec<u8>, name: &[u8], words: impl IntoIterator<Item = &'w [u8]>) -> usize {
    out.extend_from_slice(name);
    let mut count = 0;
    for word in words {
        out.push(b' ');
        // A byte that is no text is as wrong as any other sign.
        out.extend(word.iter().map(|byte| if byte.is_ascii() { *byte } else { b'?' }));
        count += 1;
    }
    out.push(b'\n');
    count
}

/// The vertex of a corner such as `7/2/1`.
fn vertex(corner: &[u8]) -> &[u8] {
    corner.split(|byte| *byte == b'/').next().unwrap_or_default()
}

fn add(model: &tobj::Mesh, polygons: &mut Polygons) -> Result<(), String> {
    let vertices = model.positions.len() / 3;
    if vertices > MAX {
        return Err(format!("more than {MAX} vertices"));
    }
    let points = model.positions.chunks_exact(3);
    polygons.mesh.positions.extend(points.map(|p| Vec3::new(p[0], p[1], p[2])));
    let mut corners = model.indices.as_slice();
    for arity in &model.face_arities {
        let (face, rest) = corners.split_at(*arity as usize);
        corners = rest;
        // Those of one corner are the marks.
        if face.len() >= 3 {
            polygons.fan(face)?;
        }
    }
    Ok(())
}
