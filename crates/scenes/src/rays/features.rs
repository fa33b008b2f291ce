//! Objects as corners, edges and faces, whatever they are.

use crate::random::Random;
use accel::{Aabb, Geometry, Vec3};
use glam::DVec3;

/// A face of object `object`: a triangle's corners, or those of one of the faces of a box, its own or the one about it.
pub fn face(geometry: &Geometry, random: &mut Random, object: usize) -> Vec<Vec3> {
    match geometry {
        Geometry::Triangles(mesh) => mesh.corners(object).to_vec(),
        Geometry::Boxes(boxes) => face_of_box(&boxes[object], random),
        Geometry::Solids(solids) => face_of_box(&solids[object].bounds(), random),
    }
}

fn face_of_box(b: &Aabb, random: &mut Random) -> Vec<Vec3> {
    let axis = random.below(3);
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let base = if random.below(2) == 0 { b.min } else { b.max };
    let corner = |u: Vec3, v: Vec3| {
        let mut p = base;
        (p[x], p[y]) = (u[x], v[y]);
        p
    };
    vec![corner(b.min, b.min), corner(b.max, b.min), corner(b.max, b.max), corner(b.min, b.max)]
}

/// A face of a random object. The scene must have one.
pub fn any_face(geometry: &Geometry, random: &mut Random) -> Vec<Vec3> {
    let object = random.below(geometry.len());
    face(geometry, random, object)
}

/// The unit normal of a face, or `None` where it has no area. In double precision, scaled by the largest
/// edge so that tiny and huge faces have one too.
pub fn normal(face: &[Vec3]) -> Option<DVec3> {
    let [a, b, c] = [0, 1, 2].map(|i| face[i].as_dvec3());
    let (ab, ac) = (b - a, c - a);
    let size = ab.abs().max(ac.abs()).max_element();
    (size > 0.0).then(|| (ab / size).cross(ac / size)).and_then(DVec3::try_normalize)
}

/// A point in a face, rounded.
pub fn point_in(face: &[Vec3], random: &mut Random) -> Vec3 {
    let [a, b, c] = [0, 1, 2].map(|i| face[i].as_dvec3());
    let (mut u, mut v) = (random.unit(), random.unit());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    (a + (b - a) * u + (c - a) * v).as_vec3()
}

/// A point of one of a face's edges, rounded: often the middle or a quarter.
pub fn point_on_edge(face: &[Vec3], random: &mut Random) -> Vec3 {
    let k = random.below(face.len());
    let (a, b) = (face[k].as_dvec3(), face[(k + 1) % face.len()].as_dvec3());
    let s = match random.below(4) {
        0 => 0.5,
        1 => 0.25,
        _ => random.unit(),
    };
    (a + (b - a) * s).as_vec3()
}

/// One of a face's corners, exactly.
pub fn corner(face: &[Vec3], random: &mut Random) -> Vec3 {
    face[random.below(face.len())]
}
