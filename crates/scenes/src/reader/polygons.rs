//! A mesh as its polygons come in.

use accel::Mesh;

/// The most vertices or triangles of a mesh: one number is left over to mean "none".
pub const MAX: usize = u32::MAX as usize - 1;

/// A mesh and what of its file is not in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygons {
    /// Triangles in file order, polygons fanned from their first corner.
    pub mesh: Mesh,
    /// Faces of fewer than three corners.
    pub skipped: u64,
}

impl Polygons {
    /// Adds the fan of a polygon, or counts it where it has fewer than three corners.
    ///
    /// # Errors
    /// In words, that there are too many triangles.
    pub fn fan(&mut self, corners: &[u32]) -> Result<(), String> {
        let [first, rest @ ..] = corners else {
            self.skipped += 1;
            return Ok(());
        };
        if rest.len() < 2 {
            self.skipped += 1;
            return Ok(());
        }
        if self.mesh.triangles.len() + corners.len() > MAX {
            return Err(format!("more than {MAX} triangles"));
        }
        self.mesh.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        Ok(())
    }
}
