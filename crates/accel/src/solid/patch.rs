//! Parametric patches.

use super::error::Fields;
use super::{Shape, SolidError, placed};
use crate::{Aabb, Vec3};
use glam::DVec3;

/// The 4 × 4 control points of a bicubic Bézier patch, seen from both sides: `points[j][i]` belongs to the i-th Bernstein
/// polynomial of u and the j-th of v. It is no closed object.
pub type Net = [[Vec3; 4]; 4];

/// A bicubic Bézier patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    net: Box<Net>,
}

/// The cubic Bernstein polynomials.
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

impl Patch {
    /// The patch of these control points.
    pub fn new(net: Net) -> Self {
        Self { net: Box::new(net) }
    }

    /// The control points.
    pub fn net(&self) -> &Net {
        &self.net
    }

    /// The point at (u, v).
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        self.weighted(bernstein(u), bernstein(v))
    }

    /// The derivatives in u and in v.
    pub fn tangents(&self, u: f64, v: f64) -> [DVec3; 2] {
        [self.weighted(slopes(u), bernstein(v)), self.weighted(bernstein(u), slopes(v))]
    }

    /// The unit normal at (u, v): where the patch is drawn together to a point, that from a little beside it.
    pub fn normal_at(&self, u: f64, v: f64) -> Option<DVec3> {
        [0.0, 1e-4, 1e-2].into_iter().find_map(|step| {
            let inward = |t: f64| t + step * (0.5 - t);
            let [along_u, along_v] = self.tangents(inward(u), inward(v));
            let size = along_u.abs().max(along_v.abs()).max_element();
            let normal = along_u.cross(along_v) / (size * size);
            (normal.length() > 1e-9).then(|| normal.normalize())
        })
    }

    fn weighted(&self, in_u: [f64; 4], in_v: [f64; 4]) -> DVec3 {
        let row = |row: &[Vec3; 4]| -> DVec3 { row.iter().zip(in_u).map(|(p, w)| p.as_dvec3() * w).sum() };
        self.net.iter().zip(in_v).map(|(points, w)| row(points) * w).sum()
    }

    /// About where the patch is nearest to a point: the best of a grid, improved by steps along the tangents.
    pub(super) fn nearest(&self, point: DVec3) -> [f64; 2] {
        const GRID: u32 = 8;
        let place = |i: u32| f64::from(i) / f64::from(GRID);
        let places = (0..=GRID).flat_map(|j| (0..=GRID).map(move |i| [place(i), place(j)]));
        let away = |[u, v]: [f64; 2]| self.at(u, v).distance_squared(point);
        let mut best = places.min_by(|a, b| away(*a).total_cmp(&away(*b))).unwrap_or([0.5; 2]);
        for _ in 0..12 {
            let [u, v] = best;
            let ([a, b], rest) = (self.tangents(u, v), point - self.at(u, v));
            let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
            let det = aa * bb - ab * ab;
            if det <= 1e-12 * aa * bb {
                break;
            }
            let step =
                [(rest.dot(a) * bb - rest.dot(b) * ab) / det, (rest.dot(b) * aa - rest.dot(a) * ab) / det];
            let next = [(u + step[0]).clamp(0.0, 1.0), (v + step[1]).clamp(0.0, 1.0)];
            if away(next) >= away(best) {
                break;
            }
            best = next;
        }
        best
    }
}

impl Shape for Patch {
    const KIND: &'static str = "patch";

    fn bounds(&self) -> Aabb {
        Aabb::of_points(self.net.iter().flatten().copied())
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let [u, v] = self.nearest(point);
        self.normal_at(u, v)
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        Self::new(self.net.map(|row| row.map(|point| placed(point, scale, offset))))
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.net.iter().flatten().flat_map(|point| point.to_array()).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        self.net.iter().flatten().try_for_each(|point| Fields(Self::KIND).finite("points", &point.to_array()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = u, y = v, z a saddle.
    fn saddle() -> Patch {
        let at = |i: usize| i as f32 / 3.0;
        Patch::new(std::array::from_fn(|j| {
            std::array::from_fn(|i| Vec3::new(at(i), at(j), if i % 3 == j % 3 { 0.5 } else { 0.0 }))
        }))
    }

    #[test]
    fn tangents_are_slopes() {
        let patch = saddle();
        for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, 0.5)] {
            let [along_u, along_v] = patch.tangents(u, v);
            let step = 1e-6;
            let near_u = (patch.at(u + step, v) - patch.at(u - step, v)) / (2.0 * step);
            let near_v = (patch.at(u, v + step) - patch.at(u, v - step)) / (2.0 * step);
            assert!(along_u.distance(near_u) < 1e-8 && along_v.distance(near_v) < 1e-8);
        }
    }

    #[test]
    fn normals_are_found_from_points() {
        let patch = saddle();
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.05)] {
            let (expected, found) = (patch.normal_at(u, v).unwrap(), patch.normal(patch.at(u, v)).unwrap());
            assert!(expected.distance(found) < 1e-6, "{expected} {found}");
        }
        let fan = Patch::new([
            [Vec3::ZERO; 4],
            [Vec3::X; 4],
            [Vec3::X * 2.0; 4],
            [0.0, 1.0, 2.0, 3.0].map(|y| Vec3::new(3.0, y, 0.0)),
        ]);
        assert_eq!(fan.normal_at(0.5, 0.0).map(|n| n.abs()), Some(DVec3::Z));
    }
}
