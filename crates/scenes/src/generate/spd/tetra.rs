use crate::solid::Solid;
use glam::DVec3;

/// A tetrahedral pyramid of 4^(sf−1) tetrahedra, 4^sf triangles. `sf` is at least 1.
pub fn tetra(sf: u32) -> Vec<Solid> {
    let mut solids = Vec::new();
    divide(&mut solids, DVec3::ZERO, 1.0, sf.max(1) - 1);
    solids
}

/// Corners of a cube whose signs multiply to +1: they span a regular tetrahedron.
const SIGNS: [DVec3; 4] = [
    DVec3::new(1.0, 1.0, 1.0),
    DVec3::new(1.0, -1.0, -1.0),
    DVec3::new(-1.0, 1.0, -1.0),
    DVec3::new(-1.0, -1.0, 1.0),
];

fn divide(solids: &mut Vec<Solid>, center: DVec3, half: f64, depth: u32) {
    if depth > 0 {
        for sign in SIGNS {
            divide(solids, center + sign * (half / 2.0), half / 2.0, depth - 1);
        }
    } else {
        let corner = SIGNS.map(|sign| center + sign * half);
        for face in [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] {
            solids.push(Solid::convex(face.map(|i: usize| corner[i]).to_vec()));
        }
    }
}
