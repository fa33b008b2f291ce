//! Coordinates of a vertex as text.

use super::lines::{Lines, show};
use crate::error::SceneError;
use accel::Vec3;
use std::io::Read;

/// A coordinate triple from three words of vertex number `vertex` (from 1).
pub fn position(lines: &Lines<impl Read>, words: [&[u8]; 3], vertex: usize) -> Result<Vec3, SceneError> {
    let mut p = [0.0; 3];
    for (x, word) in p.iter_mut().zip(words) {
        *x = std::str::from_utf8(word)
            .ok()
            .and_then(|word| word.parse::<f32>().ok())
            .ok_or_else(|| lines.syntax(format!("vertex {vertex} has `{}` for a coordinate", show(word))))?;
        if !x.is_finite() {
            let (path, line) = (lines.path().to_owned(), Some(lines.number()));
            return Err(SceneError::NotFinite { path, line, vertex: vertex as u64, value: show(word) });
        }
    }
    Ok(Vec3::from_array(p))
}
