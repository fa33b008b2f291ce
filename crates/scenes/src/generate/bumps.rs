//! Closed surfaces: a bumpy sphere and a plain one.

use crate::solid::{round, unit_sphere};
use accel::Mesh;
use glam::DVec3;

/// A closed sphere of radius about 1 with bumps of height `height`, of about `triangles`
/// triangles (8f² for the nearest whole f). Corners are shared: the mesh is watertight.
pub fn bumps(triangles: u32, height: f64) -> Mesh {
    sphere(triangles, |p| {
        let wave = libm::sin(11.0 * p.x) * libm::sin(13.0 * p.y + 0.5) * libm::sin(12.0 * p.z + 1.0);
        let ripple = libm::sin(41.0 * p.x + 1.0) + libm::sin(43.0 * p.y) + libm::sin(37.0 * p.z + 2.0);
        p * (1.0 + height * (0.75 * wave + 0.25 / 3.0 * ripple))
    })
}

/// A closed sphere of about `triangles` triangles with `radius` and `center`.
pub fn ball(triangles: u32, radius: f64, center: DVec3) -> Mesh {
    sphere(triangles, |p| center + p * radius)
}

fn sphere(triangles: u32, shape: impl Fn(DVec3) -> DVec3) -> Mesh {
    let frequency = (f64::from(triangles) / 8.0).sqrt().round() as u32;
    let (points, triangles) = unit_sphere(frequency);
    Mesh { positions: points.into_iter().map(|p| round(shape(p))).collect(), triangles }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::is_watertight;

    #[test]
    fn bumps_are_closed_and_of_the_size_asked_for() {
        let mesh = bumps(20_000, 0.1);
        assert!((19_500..20_500).contains(&mesh.triangles.len()));
        assert!(is_watertight(&mesh));
        assert!(mesh.positions.iter().all(|p| (0.9..=1.1).contains(&p.length())));
    }

    #[test]
    fn no_two_corners_of_a_closed_mesh_coincide() {
        let mesh = bumps(20_000, 0.1);
        let distinct: std::collections::HashSet<_> =
            mesh.positions.iter().map(|p| p.to_array().map(f32::to_bits)).collect();
        assert_eq!(distinct.len(), mesh.positions.len());
    }
}
