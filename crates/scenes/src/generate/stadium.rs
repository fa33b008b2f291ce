//! A small detailed thing in a large plain hall: two scales in one scene.

use super::spd::teapot;
use crate::solid::round;
use accel::Mesh;
use glam::DVec3;

/// The teapot with `n` × `n` cells a patch (64n² − 8n triangles) on the floor of a hall of 12
/// triangles, `hall` units wide, deep, and half as high.
pub fn stadium(n: u32, hall: f64) -> Mesh {
    let mut mesh = teapot(n);
    let first = mesh.positions.len() as u32;
    for i in 0..8 {
        let corner = DVec3::new(f64::from(i & 1) - 0.5, f64::from(i >> 1 & 1) - 0.5, f64::from(i >> 2) * 0.5);
        mesh.positions.push(round(corner * hall));
    }
    let walls = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    for [a, b, c, d] in walls.map(|wall| wall.map(|i| first + i)) {
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_teapot_is_detailed_and_the_hall_is_not() {
        let mesh = stadium(32, 400.0);
        assert_eq!(mesh.triangles.len(), 64 * 32 * 32 - 8 * 32 + 12);
    }
}
