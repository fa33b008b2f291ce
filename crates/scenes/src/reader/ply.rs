//! ASCII PLY (G. Turk 1994, <http://paulbourke.net/dataformats/ply/>): vertices and faces.

use super::lines::{Lines, show};
use super::polygons::{MAX, Polygons};
use super::position::position;
use crate::error::SceneError;
use accel::Mesh;
use std::io::Read;

#[derive(Default)]
struct Element {
    name: Vec<u8>,
    count: u64,
    /// Name, and whether it is a list.
    properties: Vec<(Vec<u8>, bool)>,
}

/// Reads the mesh.
pub fn read(mut lines: Lines<impl Read>) -> Result<Polygons, SceneError> {
    let elements = header(&mut lines)?;
    let mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    let mut polygons = Polygons { mesh, skipped: 0 };
    let mut vertices = None;
    for element in &elements {
        let mut done = 0;
        while done < element.count {
            if !lines.advance()? {
                let (name, count) = (show(&element.name), element.count);
                return Err(lines.syntax(format!("the file ends after {done} of {count} `{name}` lines")));
            }
            if lines.words(None).next().is_none() {
                continue;
            }
            match element.name.as_slice() {
                b"vertex" => vertex(&lines, element, &mut polygons.mesh)?,
                b"face" => face(&lines, element, &mut polygons, vertices)?,
                _ => {}
            }
            done += 1;
        }
        if element.name == b"vertex" {
            vertices = Some(polygons.mesh.positions.len());
        }
    }
    let Polygons { mesh, skipped } = &polygons;
    if mesh.triangles.is_empty() {
        let (path, vertices) = (lines.path().to_owned(), mesh.positions.len() as u64);
        return Err(SceneError::NoFaces { path, lines: lines.number(), vertices, skipped: *skipped });
    }
    Ok(polygons)
}

fn header(lines: &mut Lines<impl Read>) -> Result<Vec<Element>, SceneError> {
    let mut elements: Vec<Element> = Vec::new();
    let mut is_first = true;
    while lines.advance()? {
        let words: Vec<&[u8]> = lines.words(None).collect();
        if std::mem::take(&mut is_first) {
            if words != [b"ply"] {
                return Err(lines.syntax("a PLY file begins with the line `ply`".into()));
            }
            continue;
        }
        match words[..] {
            [b"format", b"ascii", _] | [b"comment" | b"obj_info", ..] | [] => {}
            [b"format", format, ..] => {
                let format = show(format);
                return Err(lines
                    .syntax(format!("the format is `{format}`: only ASCII PLY is read, convert it first")));
            }
            [b"element", name, count] => {
                let count = std::str::from_utf8(count).ok().and_then(|text| text.parse().ok());
                let count =
                    count.ok_or_else(|| lines.syntax("an element's count must be a whole number".into()))?;
                elements.push(Element { name: name.to_vec(), count, properties: Vec::new() });
            }
            [b"property", b"list", _, _, name] | [b"property", _, name] => {
                let is_list = words.len() == 5;
                let Some(element) = elements.last_mut() else {
                    return Err(lines.syntax("a property before the first element".into()));
                };
                element.properties.push((name.to_vec(), is_list));
            }
            [b"end_header"] => return Ok(elements),
            [other, ..] => {
                return Err(lines.syntax(format!("`{}` has no place in a PLY header", show(other))));
            }
        }
    }
    Err(lines.syntax("the header has no `end_header`".into()))
}

fn vertex(lines: &Lines<impl Read>, element: &Element, mesh: &mut Mesh) -> Result<(), SceneError> {
    let number = mesh.positions.len() + 1;
    if number > MAX {
        return Err(lines.too_large("vertices", MAX));
    }
    let mut words = lines.words(None);
    let mut xyz: [Option<&[u8]>; 3] = [None; 3];
    for (name, is_list) in &element.properties {
        let word = words.next();
        if *is_list {
            let length = word.and_then(whole).unwrap_or(0);
            words.by_ref().take(length as usize).for_each(drop);
        } else if let Some(axis) = [b"x", b"y", b"z"].iter().position(|axis| name == *axis) {
            xyz[axis] = word;
        }
    }
    let [Some(x), Some(y), Some(z)] = xyz else {
        return Err(lines.syntax(format!("vertex {number} lacks a coordinate")));
    };
    mesh.positions.push(position(lines, [x, y, z], number)?);
    Ok(())
}

fn face(
    lines: &Lines<impl Read>,
    element: &Element,
    polygons: &mut Polygons,
    vertices: Option<usize>,
) -> Result<(), SceneError> {
    let Some(vertices) = vertices else {
        return Err(lines.syntax("faces before the vertices are not read".into()));
    };
    let mut words = lines.words(None);
    for (name, is_list) in &element.properties {
        let word = words.next();
        if !is_list {
            continue;
        }
        let Some(length) = word.and_then(whole) else {
            return Err(lines.syntax("a list's length must be a whole number".into()));
        };
        if !matches!(name.as_slice(), b"vertex_indices" | b"vertex_index") {
            words.by_ref().take(length as usize).for_each(drop);
            continue;
        }
        let mut corners = Vec::new();
        for word in words.by_ref().take(length as usize) {
            let Some(index) = whole(word) else {
                return Err(lines.syntax(format!("a face has `{}` for a corner", show(word))));
            };
            if index < 0 || index as usize >= vertices {
                let (path, line) = (lines.path().to_owned(), lines.number());
                return Err(SceneError::IndexOutOfRange { path, line, index, vertices: vertices as u64 });
            }
            corners.push(index as u32);
        }
        if corners.len() as i64 != length {
            return Err(
                lines.syntax(format!("the face announces {length} corners and has {}", corners.len()))
            );
        }
        return polygons.fan(&corners).map_err(|_| lines.too_large("triangles", MAX));
    }
    Err(lines.syntax("the faces have no property `vertex_indices`".into()))
}

fn whole(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
