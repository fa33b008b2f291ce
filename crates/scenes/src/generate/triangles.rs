//! Random triangles in the unit cube: scattered, overlapping, or drawn out to needles.

use crate::random::Random;
use crate::solid::round;
use accel::Mesh;
use glam::DVec3;

/// Mean distance of two uniform points of the unit cube (Robbins' constant).
const ROBBINS: f64 = 0.661_707_182_267_176_2;

/// `count` separate triangles, their centres uniform in the unit cube and their mean edge
/// `edge`/∛`count`: `edge` below 1 leaves them scattered, above 1 they overlap.
pub fn scattered(count: u32, edge: f64, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let half = 0.5 * edge / (libm::cbrt(f64::from(count)) * ROBBINS);
    soup(count, || {
        let center = random.in_cube(0.0, 1.0);
        [(); 3].map(|()| center + random.in_cube(-half, half))
    })
}

/// `count` triangles of length `length` in random directions, `aspect` times as long as wide.
pub fn needles(count: u32, length: f64, aspect: f64, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    soup(count, || {
        let center = random.in_cube(0.0, 1.0);
        let along = random.direction();
        let across = loop {
            let across = along.cross(random.direction());
            if across.length_squared() > 0.01 {
                break across.normalize() * (length / aspect);
            }
        };
        let tail = center - along * (0.5 * length);
        [tail, tail + across, center + along * (0.5 * length)]
    })
}

/// A mesh of `count` triangles that share no corner.
pub fn soup(count: u32, mut triangle: impl FnMut() -> [DVec3; 3]) -> Mesh {
    let mut positions = Vec::with_capacity(3 * count as usize);
    for _ in 0..count {
        positions.extend(triangle().map(round));
    }
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { positions, triangles }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_edge(mesh: &Mesh) -> f64 {
        let edges = mesh.triangles.iter().flat_map(|t| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
            [a.distance(b), b.distance(c), c.distance(a)]
        });
        edges.sum::<f64>() / (3 * mesh.triangles.len()) as f64
    }

    #[test]
    fn the_mean_edge_is_what_was_asked_for() {
        for edge in [0.3, 1.5] {
            let mesh = scattered(8000, edge, 1);
            assert_eq!(mesh.triangles.len(), 8000);
            let mean = mean_edge(&mesh) * 20.0;
            assert!((mean / edge - 1.0).abs() < 0.02, "{mean} {edge}");
        }
    }

    #[test]
    fn needles_are_thin() {
        let mesh = needles(100, 0.3, 1000.0, 1);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
            let aspect = a.distance(c) / a.distance(b);
            assert!((900.0..1100.0).contains(&aspect), "{aspect}");
        }
    }
}
