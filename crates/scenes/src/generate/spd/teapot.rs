//! Newell's teapot: 32 bicubic Bézier patches (M. Newell 1975; F. Crow, "The Origins of the
//! Teapot", IEEE CG&A 7(1), 1987).
//!
//! Rim, body, lid and bottom are surfaces of revolution in four quarters, handle and spout
//! pairs of mirrored halves; the control points follow from profiles by these symmetries.

use crate::solid::{Solid, round};
use accel::Mesh;
use glam::DVec3;
use std::collections::HashMap;

type Patch = [[DVec3; 4]; 4];

/// Control points (radius, z) of the surfaces of revolution: rim, body, lid, bottom.
const PROFILES: [[(f64, f64); 4]; 6] = [
    [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)],
    [(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)],
    [(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)],
    [(0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)],
    [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)],
    [(0.0, 0.0), (1.425, 0.0), (1.5, 0.075), (1.5, 0.15)],
];

/// A row of a mirrored patch: where the row starts and ends, (x, z) each in the plane y = 0,
/// and the half-width of its inner control points.
type Row = ((f64, f64), (f64, f64), f64);

/// Handle and spout, each two patches in sequence.
const HALVES: [[Row; 4]; 4] = [
    [
        ((-1.6, 2.025), (-1.5, 2.25), 0.3),
        ((-2.3, 2.025), (-2.5, 2.25), 0.3),
        ((-2.7, 2.025), (-3.0, 2.25), 0.3),
        ((-2.7, 1.8), (-3.0, 1.8), 0.3),
    ],
    [
        ((-2.7, 1.8), (-3.0, 1.8), 0.3),
        ((-2.7, 1.575), (-3.0, 1.35), 0.3),
        ((-2.5, 1.125), (-2.65, 0.9375), 0.3),
        ((-2.0, 0.9), (-1.9, 0.6), 0.3),
    ],
    [
        ((1.7, 1.425), (1.7, 0.6), 0.66),
        ((2.6, 1.425), (3.1, 0.825), 0.66),
        ((2.3, 2.1), (2.4, 2.025), 0.25),
        ((2.7, 2.4), (3.3, 2.4), 0.25),
    ],
    [
        ((2.7, 2.4), (3.3, 2.4), 0.25),
        ((2.8, 2.475), (3.525, 2.49375), 0.25),
        ((2.9, 2.475), (3.45, 2.5125), 0.15),
        ((2.8, 2.4), (3.2, 2.4), 0.15),
    ],
];

/// The 32 patches.
fn patches() -> Vec<Patch> {
    let mut patches = Vec::with_capacity(32);
    for (number, profile) in PROFILES.iter().enumerate() {
        for quarter in 0..4 {
            patches.push(profile.map(|(r, z)| {
                // The published lid has 0.45 where the other circles have 0.56 of the radius.
                let bulge = if number == 3 && r == 0.8 { 0.45 } else { 0.56 * r };
                [(r, 0.0), (r, -bulge), (bulge, -r), (0.0, -r)].map(|(x, y)| {
                    let (x, y) = (0..quarter).fold((x, y), |(x, y), _| (y, -x));
                    DVec3::new(x, y, z)
                })
            }));
        }
    }
    for rows in HALVES {
        for side in [-1.0, 1.0] {
            patches.push(rows.map(|((x0, z0), (x1, z1), width)| {
                let y = side * width;
                [(x0, 0.0, z0), (x0, y, z0), (x1, y, z1), (x1, 0.0, z1)].map(|(x, y, z)| DVec3::new(x, y, z))
            }));
        }
    }
    patches
}

/// The 32 patches as objects.
pub fn teapot_patches() -> Vec<accel::Solid> {
    let patch = |patch: Patch| accel::Solid::Patch(accel::solid::Patch::new(patch.map(|row| row.map(round))));
    patches().into_iter().map(patch).collect()
}

fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn evaluate(patch: &Patch, u: f64, v: f64) -> DVec3 {
    let (bu, bv) = (bernstein(u), bernstein(v));
    let row = |row: &[DVec3; 4]| row[0] * bu[0] + row[1] * bu[1] + row[2] * bu[2] + row[3] * bu[3];
    row(&patch[0]) * bv[0] + row(&patch[1]) * bv[1] + row(&patch[2]) * bv[2] + row(&patch[3]) * bv[3]
}

/// The teapot with each patch cut into 2·`n`² triangles, less the 8·`n` that collapse in the
/// cusps of lid and bottom: 64n² − 8n in all. Points that patches share become one corner.
pub fn teapot(n: u32) -> Mesh {
    let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    let mut known = HashMap::new();
    for patch in patches() {
        let mut corner = |i: u32, j: u32| {
            let p = round(evaluate(&patch, f64::from(i) / f64::from(n), f64::from(j) / f64::from(n)));
            *known.entry(p.to_array().map(f32::to_bits)).or_insert_with(|| {
                mesh.positions.push(p);
                mesh.positions.len() as u32 - 1
            })
        };
        for j in 0..n {
            for i in 0..n {
                let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                for [p, q, r] in [[a, b, c], [a, c, d]] {
                    if p != q && q != r && r != p {
                        mesh.triangles.push([p, q, r]);
                    }
                }
            }
        }
    }
    mesh
}

/// The n × n squares of [−4, 4]² that the published scene puts below the teapot.
pub fn checkerboard(n: u32) -> Vec<Solid> {
    let flat = |i: u32| 4.0 * (2.0 * f64::from(i) / f64::from(n) - 1.0);
    let corner = |x: u32, y: u32| DVec3::new(flat(x), flat(y), 0.0);
    (0..n * n)
        .map(|k| (k % n, k / n))
        .map(|(x, y)| {
            Solid::convex(vec![corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        assert_eq!(patches().len(), 32);
        assert_eq!(teapot(12).triangles.len(), 9120);
        assert_eq!(teapot(2).triangles.len(), 240);
        assert_eq!(checkerboard(12).len(), 144);
    }

    #[test]
    fn the_body_is_closed_at_its_seams() {
        let mesh = teapot(4);
        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        for &[a, b, c] in &mesh.triangles {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                *edges.entry((p.min(q), p.max(q))).or_default() += 1;
            }
        }
        // Open are: the rim's inner edge, the lid's edge, both ends of handle and spout.
        let open = edges.values().filter(|&&n| n == 1).count();
        assert_eq!(open, 16 + 16 + 4 * 8);
        assert!(edges.values().all(|&n| n <= 2));
    }

    #[test]
    fn bounds_are_the_published_ones() {
        let mesh = teapot(16);
        let top = mesh.positions.iter().fold(f32::MIN, |z, p| z.max(p.z));
        let bottom = mesh.positions.iter().fold(f32::MAX, |z, p| z.min(p.z));
        assert_eq!((bottom, top), (0.0, 3.15));
    }
}
