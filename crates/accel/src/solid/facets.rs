//! Objects that contain facets.

use super::{Shape, SolidError, placed};
use crate::{Aabb, Corners, Mesh, Vec3, morton, tolerance, vec_bytes};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// A closed mesh as one object: a structure sees its box, and its facets are its own affair (Skala 1993, §7, "objects that
/// contain facets").
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    mesh: Arc<Mesh>,
    bounds: Aabb,
    /// The triangles along a curve through space.
    order: Arc<[u32]>,
    /// Boxes of [`FACETS`] neighbours of the order, then of as many boxes of the level before, up to one.
    levels: Arc<[Vec<Aabb>]>,
}

/// Facets, or boxes, in a box.
const FACETS: usize = 8;

impl Facets {
    /// Of a mesh, which has to be closed to be valid.
    pub fn new(mesh: Arc<Mesh>) -> Self {
        let bounds = mesh.bounds();
        let box_of = |i: u32| Aabb::of_points(mesh.corners(i as usize));
        let extent = bounds.extent().max_element();
        let cells = if extent > 0.0 { ((1 << morton::BITS) - 1) as f32 / extent } else { 0.0 };
        let key = |i: &u32| {
            let at = (box_of(*i).center() - bounds.min) * cells;
            at.to_array().iter().enumerate().fold(0, |key, (axis, c)| key | morton::spread(*c as u32) << axis)
        };
        let mut order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        order.sort_by_cached_key(key);
        // Wider by more than a test of them is off by.
        let pad = tolerance::pad_of(&bounds);
        let union = |boxes: &[Aabb]| boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(*one));
        let facets = |ids: &[u32]| ids.iter().fold(Aabb::EMPTY, |all, id| all.union(box_of(*id))).padded(pad);
        let mut levels = vec![order.chunks(FACETS).map(facets).collect::<Vec<_>>()];
        while let Some(below) = levels.last().filter(|level| level.len() > 1) {
            levels.push(below.chunks(FACETS).map(union).collect());
        }
        Self { mesh, bounds, order: order.into(), levels: levels.into() }
    }

    /// Calls `with` with every facet whose surroundings `meets` says are met.
    pub fn visit(&self, mut meets: impl FnMut(&Aabb) -> bool, mut with: impl FnMut(Corners)) {
        let mut waiting = vec![(self.levels.len() - 1, 0)];
        while let Some((level, at)) = waiting.pop() {
            if !self.levels[level].get(at).is_some_and(&mut meets) {
                continue;
            }
            let below = at * FACETS;
            if level > 0 {
                let end = (below + FACETS).min(self.levels[level - 1].len());
                waiting.extend((below..end).rev().map(|at| (level - 1, at)));
            } else {
                let end = (below + FACETS).min(self.order.len());
                self.order[below..end].iter().for_each(|id| with(self.mesh.corners(*id as usize)));
            }
        }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Bytes that it holds beside itself.
    pub fn bytes(&self) -> usize {
        let levels: usize = self.levels.iter().map(vec_bytes).sum();
        vec_bytes(&self.mesh.positions) + vec_bytes(&self.mesh.triangles) + size_of_val(&*self.order) + levels
    }

    /// The facet that is nearest to a point, and how far away it is.
    pub(super) fn nearest(&self, point: DVec3) -> Option<(usize, f64)> {
        let away = |i: usize| distance(self.mesh.corners(i).map(|corner| corner.as_dvec3()), point);
        (0..self.mesh.triangles.len()).map(|i| (i, away(i))).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// How often each edge is passed forwards less how often backwards, by the places of its ends: corners at the same place are one.
fn open_edge(mesh: &Mesh) -> Option<[Vec3; 2]> {
    let mut edges = HashMap::new();
    let bits = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    for i in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(i);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (bits(p), bits(q));
            let (key, step) = if from <= to { ((from, to), 1) } else { ((to, from), -1) };
            edges.entry(key).or_insert((0i64, [p, q])).0 += if from == to { 0 } else { step };
        }
    }
    edges.into_values().filter(|(balance, _)| *balance != 0).map(|(_, ends)| ends).min_by(|a, b| {
        let key = |ends: &[Vec3; 2]| ends.map(|p| p.to_array().map(f32::to_bits));
        key(a).cmp(&key(b))
    })
}

/// How far a point is from a triangle (C. Ericson 2005, "Real-Time Collision Detection", §5.1.5, by its edges and its inside).
pub(super) fn distance([a, b, c]: [DVec3; 3], point: DVec3) -> f64 {
    let to_edge = |p: DVec3, q: DVec3| {
        let along = q - p;
        let t = ((point - p).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (p + along * if t.is_nan() { 0.0 } else { t }).distance(point)
    };
    let nearest_edge = to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a));
    let normal = (b - a).cross(c - a);
    let above = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(point - *p).dot(normal) >= 0.0);
    let height = (point - a).dot(normal).abs() / normal.length();
    if above && height < nearest_edge { height } else { nearest_edge }
}

impl Shape for Facets {
    const KIND: &'static str = "facets";

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let corners: Corners = self.mesh.corners(self.nearest(point)?.0);
        corners.normal(point)
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        let positions = self.mesh.positions.iter().map(|p| placed(*p, scale, offset)).collect();
        Self::new(Arc::new(Mesh { positions, triangles: self.mesh.triangles.clone() }))
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        for i in 0..self.mesh.triangles.len() {
            self.mesh.corners(i).iter().flat_map(|corner| corner.to_array()).for_each(&mut *see);
        }
    }

    fn validate(&self) -> Result<(), SolidError> {
        let refuse = |reason: String| Err(SolidError::new(Self::KIND, "mesh", reason));
        if self.mesh.triangles.is_empty() {
            return refuse("has no triangle".into());
        }
        if let Some(corner) = self.mesh.positions.iter().find(|p| !p.is_finite()) {
            return refuse(format!("has a corner at {corner}, which is not finite"));
        }
        match open_edge(&self.mesh) {
            Some([p, q]) => refuse(format!(
                "is not closed: the edge from {p} to {q} is not passed as often one way as the other, so nothing is inside or outside"
            )),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        Mesh { positions, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
    }

    #[test]
    fn open_meshes_are_refused_and_corners_at_one_place_are_one() {
        let closed = tetrahedron();
        assert_eq!(Facets::new(Arc::new(closed.clone())).validate(), Ok(()));
        let corners: Vec<Vec3> = (0..4).flat_map(|i| closed.corners(i)).collect();
        let torn =
            Mesh { positions: corners, triangles: (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect() };
        assert_eq!(Facets::new(Arc::new(torn)).validate(), Ok(()));
        let mut open = closed.clone();
        open.triangles.pop();
        assert!(Facets::new(Arc::new(open)).validate().unwrap_err().to_string().contains("not closed"));
        let mut turned = closed;
        turned.triangles[0].swap(0, 1);
        assert!(Facets::new(Arc::new(turned)).validate().is_err());
    }

    #[test]
    fn normals_are_those_of_the_nearest_facet() {
        let facets = Facets::new(Arc::new(tetrahedron()));
        assert_eq!(facets.normal(DVec3::new(0.2, 0.2, -0.01)), Some(DVec3::NEG_Z));
        let outward = facets.normal(DVec3::splat(0.5)).unwrap();
        assert!(outward.distance(DVec3::ONE.normalize()) < 1e-9);
        let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert!((distance([a, b, c], DVec3::new(0.2, 0.2, 2.0)) - 2.0).abs() < 1e-12);
        assert!((distance([a, b, c], DVec3::new(-3.0, -4.0, 0.0)) - 5.0).abs() < 1e-12);
    }
}
