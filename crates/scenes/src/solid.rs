//! Solids that procedural scenes are made of, and their tessellation.

use accel::{Mesh, Vec3};
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// One primitive of a procedural scene, before tessellation.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// A sphere.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// The mantle of a truncated cone, open at both ends; a cylinder when the radii agree.
    Cone {
        /// Centre of the first end.
        base: DVec3,
        /// Radius of the first end.
        base_radius: f64,
        /// Centre of the second end.
        apex: DVec3,
        /// Radius of the second end.
        apex_radius: f64,
    },
    /// A plane polygon with its cut into triangles.
    Polygon {
        /// Corners in order.
        corners: Vec<DVec3>,
        /// Indices into `corners`.
        triangles: Vec<[u32; 3]>,
    },
}

impl Solid {
    /// A convex polygon, fanned from its first corner.
    pub fn convex(corners: Vec<DVec3>) -> Self {
        let triangles = (2..corners.len() as u32).map(|i| [0, i - 1, i]).collect();
        Self::Polygon { corners, triangles }
    }

    /// The square of half-width `half` about the origin in the plane z = `z`.
    pub fn ground(half: f64, z: f64) -> Self {
        let corner = |x: f64, y: f64| DVec3::new(x * half, y * half, z);
        Self::convex(vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
    }
}

/// Rounds to single precision and turns −0 into 0, so that equal points have equal bits.
pub fn round(p: DVec3) -> Vec3 {
    p.as_vec3() + Vec3::ZERO
}

/// A mesh of the solids, in order. `segments` is the number of edges around a cone and
/// around a sphere's equator, rounded up to a multiple of four there.
pub fn tessellate(solids: &[Solid], segments: u32) -> Mesh {
    let segments = segments.max(3);
    let ball = unit_sphere(segments.div_ceil(4));
    let circle: Vec<(f64, f64)> = (0..segments)
        .map(|i| f64::from(i) * TAU / f64::from(segments))
        .map(|angle| (libm::cos(angle), libm::sin(angle)))
        .collect();
    let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    for solid in solids {
        match solid {
            Solid::Sphere { center, radius } => {
                append(&mut mesh, ball.0.iter().map(|p| *center + *p * *radius), &ball.1);
            }
            Solid::Cone { base, base_radius, apex, apex_radius } => {
                let (x, y) = (*apex - *base).normalize_or(DVec3::Z).any_orthonormal_pair();
                let ring = |center: DVec3, radius: f64| {
                    circle.iter().map(move |(cos, sin)| center + (x * *cos + y * *sin) * radius)
                };
                let n = segments;
                let sides: Vec<_> = (0..n)
                    .flat_map(|i| {
                        let j = (i + 1) % n;
                        [[i, j, n + j], [i, n + j, n + i]]
                    })
                    .collect();
                append(&mut mesh, ring(*base, *base_radius).chain(ring(*apex, *apex_radius)), &sides);
            }
            Solid::Polygon { corners, triangles } => append(&mut mesh, corners.iter().copied(), triangles),
        }
    }
    mesh
}

fn append(mesh: &mut Mesh, positions: impl Iterator<Item = DVec3>, triangles: &[[u32; 3]]) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(positions.map(round));
    mesh.triangles.extend(triangles.iter().map(|t| t.map(|i| first + i)));
}

/// The unit sphere as an octahedron whose faces are cut into `frequency`² triangles and
/// pushed out to radius 1: 8·`frequency`² triangles, 4·`frequency`² + 2 corners, closed,
/// every edge shared by two triangles that run along it in opposite directions.
pub fn unit_sphere(frequency: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let f = i64::from(frequency.max(1));
    let mut index = HashMap::new();
    let mut points = Vec::new();
    let mut corner = |x: i64, y: i64, z: i64| {
        *index.entry((x, y, z)).or_insert_with(|| {
            points.push(DVec3::new(x as f64, y as f64, z as f64).normalize());
            points.len() as u32 - 1
        })
    };
    let mut triangles = Vec::with_capacity(8 * (f * f) as usize);
    for octant in 0..8 {
        let [sx, sy, sz] = [1, 2, 4].map(|bit| if octant & bit == 0 { 1 } else { -1 });
        let mut at = |i: i64, j: i64| corner(sx * i, sy * j, sz * (f - i - j));
        let mut push = |a, b, c| triangles.push(if sx * sy * sz > 0 { [a, b, c] } else { [a, c, b] });
        for i in 0..f {
            for j in 0..f - i {
                let (a, b, c) = (at(i, j), at(i + 1, j), at(i, j + 1));
                push(a, b, c);
                if i + j + 1 < f {
                    push(b, at(i + 1, j + 1), c);
                }
            }
        }
    }
    (points, triangles)
}

/// Whether each directed edge occurs once and its reverse once: the mesh is closed and
/// consistently oriented.
#[cfg(test)]
pub fn is_watertight(mesh: &Mesh) -> bool {
    let mut edges = std::collections::HashSet::new();
    let all_new =
        mesh.triangles.iter().all(|&[a, b, c]| [(a, b), (b, c), (c, a)].into_iter().all(|e| edges.insert(e)));
    all_new && edges.iter().all(|&(a, b)| edges.contains(&(b, a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_are_closed_and_round() {
        for frequency in [1, 2, 5] {
            let (points, triangles) = unit_sphere(frequency);
            assert_eq!(triangles.len(), 8 * (frequency * frequency) as usize);
            assert_eq!(points.len(), 4 * (frequency * frequency) as usize + 2);
            let mesh = tessellate(&[Solid::Sphere { center: DVec3::ZERO, radius: 2.0 }], 4 * frequency);
            assert!(is_watertight(&mesh));
            assert!(mesh.positions.iter().all(|p| (p.length() - 2.0).abs() < 1e-6));
            let outward = mesh.triangles.iter().all(|t| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                (b - a).cross(c - a).dot(a) > 0.0
            });
            assert!(outward);
        }
    }

    #[test]
    fn a_torn_mesh_is_not_watertight() {
        let mut mesh = tessellate(&[Solid::Sphere { center: DVec3::ZERO, radius: 1.0 }], 8);
        mesh.triangles.pop();
        assert!(!is_watertight(&mesh));
    }

    #[test]
    fn cones_keep_their_radii() {
        let cone =
            Solid::Cone { base: DVec3::ZERO, base_radius: 2.0, apex: DVec3::Z * 3.0, apex_radius: 1.0 };
        let mesh = tessellate(&[cone], 12);
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (24, 24));
        for p in &mesh.positions {
            let radius = p.truncate().length();
            assert!((radius - if p.z == 0.0 { 2.0 } else { 1.0 }).abs() < 1e-6);
        }
    }
}
