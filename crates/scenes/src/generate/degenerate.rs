//! Small scenes at the edge of what a structure takes: few objects, equal ones, flat ones,
//! ones without area.

use super::triangles::{scattered, soup};
use crate::random::Random;
use crate::solid::round;
use accel::{Aabb, Mesh, Vec3};
use glam::DVec3;
use serde::Deserialize;

/// The shapes of degenerate meshes.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// No triangle.
    Empty,
    /// The triangle (0,0,0), (1,0,0), (0,1,0), `count` times.
    Equal,
    /// A square grid of about `count` triangles in the plane z = 0.25.
    Flat,
    /// `count` triangles whose three corners are one point.
    Points,
    /// `count` triangles with collinear corners, at random.
    Lines,
    /// `count` overlapping axis-aligned right triangles in each of three planes, of one
    /// coordinate each, corners on a grid of 1/8: many meet in edges and corners.
    Coplanar,
    /// Scattered triangles, a quarter of `count`, each of them four times in a row.
    Duplicates,
    /// Scattered triangles of which every fourth has collinear corners.
    Mixed,
}

/// A mesh of about `count` triangles of `shape`.
pub fn degenerate(shape: Shape, count: u32, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    match shape {
        Shape::Empty => Mesh { positions: Vec::new(), triangles: Vec::new() },
        Shape::Equal => {
            Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]; count as usize] }
        }
        Shape::Flat => flat(count),
        Shape::Points => soup(count, || [random.in_cube(0.0, 1.0); 3]),
        Shape::Lines => soup(count, || {
            let (start, step) = (eighths(&mut random), eighths(&mut random) * 0.25);
            [start, start + step, start + step + step]
        }),
        Shape::Coplanar => {
            let mut number = 0;
            soup(3 * count, || {
                let axis = number / count;
                number += 1;
                let [a, b] = [(); 2].map(|()| eighths(&mut random));
                let (x, y) = (DVec3::AXES[(axis as usize + 1) % 3], DVec3::AXES[(axis as usize + 2) % 3]);
                let plane = DVec3::AXES[axis as usize] * 0.5;
                let corner = plane + x * a.x + y * a.y;
                [corner, corner + x * (0.125 + b.x), corner + y * (0.125 + b.y)]
            })
        }
        Shape::Duplicates => {
            let single = scattered(count.div_ceil(4), 1.0, seed);
            let triangles = single.triangles.iter().flat_map(|t| [*t; 4]).collect();
            Mesh { triangles, ..single }
        }
        Shape::Mixed => {
            let mut mesh = scattered(count, 1.0, seed);
            for t in mesh.triangles.iter().step_by(4) {
                let [a, b, c] = t.map(|i| i as usize);
                mesh.positions[c] =
                    round((mesh.positions[a].as_dvec3() + mesh.positions[b].as_dvec3()) * 0.5);
            }
            mesh
        }
    }
}

/// Axis-aligned boxes on a grid of `side`³ cells that share faces, edges and corners; every
/// third is flat.
pub fn stacked_boxes(side: u32) -> Vec<Aabb> {
    let cell = 1.0 / side as f32;
    (0..side * side * side)
        .map(|i| {
            let min = Vec3::new((i % side) as f32, (i / side % side) as f32, (i / side / side) as f32) * cell;
            let size = if i % 3 == 0 { Vec3::new(cell, cell, 0.0) } else { Vec3::splat(cell) };
            Aabb { min, max: min + size }
        })
        .collect()
}

fn eighths(random: &mut Random) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| random.below(8) as f64 / 8.0))
}

fn flat(count: u32) -> Mesh {
    let side = (f64::from(count) / 2.0).sqrt().round().max(1.0) as u32;
    let stride = side + 1;
    let positions = (0..stride * stride)
        .map(|i| Vec3::new((i % stride) as f32 / side as f32, (i / stride) as f32 / side as f32, 0.25))
        .collect();
    let triangles = (0..side * side)
        .map(|i| i / side * stride + i % side)
        .flat_map(|a| [[a, a + 1, a + stride + 1], [a, a + stride + 1, a + stride]])
        .collect();
    Mesh { positions, triangles }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn double_area(mesh: &Mesh, t: [u32; 3]) -> f64 {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
        (b - a).cross(c - a).length()
    }

    #[test]
    fn counts() {
        for (shape, expected) in [
            (Shape::Empty, 0),
            (Shape::Equal, 100),
            (Shape::Flat, 98),
            (Shape::Points, 100),
            (Shape::Lines, 100),
            (Shape::Coplanar, 300),
            (Shape::Duplicates, 100),
            (Shape::Mixed, 100),
        ] {
            assert_eq!(degenerate(shape, 100, 1).triangles.len(), expected, "{shape:?}");
        }
        assert_eq!(stacked_boxes(4).len(), 64);
    }

    #[test]
    fn lines_and_points_have_no_area() {
        for shape in [Shape::Points, Shape::Lines] {
            let mesh = degenerate(shape, 100, 1);
            assert!(mesh.triangles.iter().all(|&t| double_area(&mesh, t) == 0.0));
        }
    }

    #[test]
    fn coplanar_triangles_lie_in_three_planes() {
        let mesh = degenerate(Shape::Coplanar, 50, 1);
        for (number, &t) in mesh.triangles.iter().enumerate() {
            assert!(t.iter().all(|&i| mesh.positions[i as usize][number / 50] == 0.5));
            assert!(double_area(&mesh, t) > 0.0);
        }
    }
}
