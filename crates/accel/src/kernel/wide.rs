//! Lanes of `f32` read as `f64`.
//!
//! [`Simd`] has no lanes of `f64`. Plain loops over rows in memory serve: compiled for
//! the instruction set of the task, they become vectors.

use crate::packet::{Packet, Vec3Lanes};
use crate::simd::{ROW, Simd};

/// Three coordinates of a row of vectors.
type Rows3 = [[f32; ROW]; 3];

/// A test's inputs in memory.
pub(super) struct Inputs {
    origin: Rows3,
    direction: Rows3,
    corners: [Rows3; 3],
}

/// The differences and products of Möller and Trumbore's test for one lane.
#[derive(Clone, Copy)]
pub(super) struct Products {
    /// Edges from the first corner.
    pub edges: [[f64; 3]; 2],
    /// The origin relative to the first corner.
    pub from_a: [f64; 3],
    /// The ray's direction.
    pub direction: [f64; 3],
    /// The determinant.
    pub det: f64,
    /// u, v and t times the determinant.
    pub scaled: [f64; 3],
}

impl Inputs {
    #[inline(always)]
    pub(super) fn of<S: Simd>(s: S, ray: &Packet<S>, corners: &[Vec3Lanes<S>; 3]) -> Self {
        let rows = |v: &Vec3Lanes<S>| {
            let mut rows = [[0.0; ROW]; 3];
            for (row, lanes) in rows.iter_mut().zip(v) {
                s.store(*lanes, row);
            }
            rows
        };
        Self {
            origin: rows(&ray.origin),
            direction: rows(&ray.direction),
            corners: [rows(&corners[0]), rows(&corners[1]), rows(&corners[2])],
        }
    }

    /// The corners of one lane.
    #[inline(always)]
    pub(super) fn corners(&self, lane: usize) -> [[f32; 3]; 3] {
        [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| self.corners[corner][axis][lane]))
    }

    /// One lane in `f64`.
    #[inline(always)]
    pub(super) fn products(&self, lane: usize) -> Products {
        let at =
            |rows: &Rows3| [f64::from(rows[0][lane]), f64::from(rows[1][lane]), f64::from(rows[2][lane])];
        let [a, b, c] = [at(&self.corners[0]), at(&self.corners[1]), at(&self.corners[2])];
        let direction = at(&self.direction);
        let (edge1, edge2) = (sub(b, a), sub(c, a));
        let from_a = sub(at(&self.origin), a);
        let p = cross(direction, edge2);
        let q = cross(from_a, edge1);
        Products {
            edges: [edge1, edge2],
            from_a,
            direction,
            det: dot(edge1, p),
            scaled: [dot(from_a, p), dot(direction, q), dot(edge2, q)],
        }
    }
}

#[inline(always)]
pub(super) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
