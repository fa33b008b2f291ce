//! Lanes of `f32` computed in `f64`.
//!
//! [`lanes::Simd`] has no lanes of `f64`. Plain loops over rows in memory serve: compiled for
//! the instruction set of the task, they become vectors.

use super::{Corners, Packed};
use accel::{Ray, Vec3};
use lanes::packet::{Packet, RayRows, Vec3Lanes};
use lanes::{ROW, Simd};

/// The differences and products of Möller and Trumbore's test.
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

impl Products {
    #[inline(always)]
    pub(super) fn of(ray: &Ray, corners: &Corners) -> Self {
        let (a, b, c) = (wide(corners[0]), wide(corners[1]), wide(corners[2]));
        let direction = wide(ray.direction);
        let (edge1, edge2) = (sub(b, a), sub(c, a));
        let from_a = sub(wide(ray.origin), a);
        let p = cross(direction, edge2);
        let q = cross(from_a, edge1);
        Self {
            edges: [edge1, edge2],
            from_a,
            direction,
            det: dot(edge1, p),
            scaled: [dot(from_a, p), dot(direction, q), dot(edge2, q)],
        }
    }
}

/// One ray against the triangles from a lane on.
#[derive(Clone, Copy)]
pub(super) struct OneRay<'a> {
    ray: &'a Ray,
    rows: [&'a [f32]; 9],
}

/// Rays against one triangle.
#[derive(Clone, Copy)]
pub(super) struct OneTriangle<'a> {
    rays: &'a RayRows,
    corners: Corners,
}

/// Rays each against the triangle in its own lane.
#[derive(Clone, Copy)]
pub(super) struct OneEach {
    rays: RayRows,
    corners: [[[f32; ROW]; 3]; 3],
}

/// The ray and the triangle that meet in each lane.
pub(super) trait Pairs {
    fn ray(&self, lane: usize) -> Ray;
    fn corners(&self, lane: usize) -> Corners;
}

impl<'a> OneRay<'a> {
    /// The triangles in `lanes` lanes.
    #[inline(always)]
    pub(super) fn new(ray: &'a Ray, packed: Packed<'a>, lanes: usize) -> Self {
        let Packed { group, lane } = packed;
        let mut rows: [&[f32]; 9] = [&[]; 9];
        for (row, values) in rows.iter_mut().zip(&group[..9]) {
            *row = &values.0[lane..lane + lanes];
        }
        Self { ray, rows }
    }
}

impl<'a> OneTriangle<'a> {
    #[inline(always)]
    pub(super) fn new(rays: &'a RayRows, packed: Packed<'_>) -> Self {
        Self { rays, corners: packed.corners() }
    }
}

impl OneEach {
    #[inline(always)]
    pub(super) fn new<S: Simd>(s: S, rays: &Packet<S>, corners: [Vec3Lanes<S>; 3]) -> Self {
        let mut rows = [[[0.0; ROW]; 3]; 3];
        for (rows, corner) in rows.iter_mut().zip(corners) {
            for (row, values) in rows.iter_mut().zip(corner) {
                s.store(values, row);
            }
        }
        Self { rays: RayRows::of(s, rays), corners: rows }
    }
}

impl Pairs for OneEach {
    #[inline(always)]
    fn ray(&self, lane: usize) -> Ray {
        self.rays.ray(lane)
    }
    #[inline(always)]
    fn corners(&self, lane: usize) -> Corners {
        let rows = &self.corners;
        let corner = |k: usize| Vec3::new(rows[k][0][lane], rows[k][1][lane], rows[k][2][lane]);
        [corner(0), corner(1), corner(2)]
    }
}

impl Pairs for OneRay<'_> {
    #[inline(always)]
    fn ray(&self, _: usize) -> Ray {
        *self.ray
    }
    #[inline(always)]
    fn corners(&self, lane: usize) -> Corners {
        let [ax, ay, az, bx, by, bz, cx, cy, cz] = self.rows;
        [
            Vec3::new(ax[lane], ay[lane], az[lane]),
            Vec3::new(bx[lane], by[lane], bz[lane]),
            Vec3::new(cx[lane], cy[lane], cz[lane]),
        ]
    }
}

impl Pairs for OneTriangle<'_> {
    #[inline(always)]
    fn ray(&self, lane: usize) -> Ray {
        self.rays.ray(lane)
    }
    #[inline(always)]
    fn corners(&self, _: usize) -> Corners {
        self.corners
    }
}

#[inline(always)]
fn wide(v: Vec3) -> [f64; 3] {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

#[inline(always)]
fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
