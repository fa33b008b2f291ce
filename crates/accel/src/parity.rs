//! Inside or outside of a closed mesh, by the parity of crossings, without error.
//!
//! A line through an edge or a corner meets several triangles there. Each edge is given to one side of the line by a rule that
//! looks at nothing but the edge: a corner on the line's dividing plane counts as below it, an edge through the line as beside
//! it. That is what an infinitely small move of the line would tell, so that every line crosses a closed mesh an even number of
//! times, and enters as often as it leaves. Signs are those of exact arithmetic (J. R. Shewchuk, *Adaptive Precision
//! Floating-Point Arithmetic and Fast Robust Geometric Predicates*, Discrete & Computational Geometry 18(3), 1997), the rule is
//! the half-open one of crossing numbers (E. Haines, *Point in Polygon Strategies*, Graphics Gems IV, 1994).

use crate::expansion::{Expansion, MINORS, sign, triple};
use crate::{Accel, Corners, MeshRef, Ray, Vec3};
use std::cmp::Ordering;

/// Where a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Outside of the mesh.
    Outside,
    /// On a triangle.
    Surface,
    /// Inside.
    Inside,
}

/// On which side a line passes through a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Against the normal that the corners turn about counterclockwise: into what the mesh encloses, if that normal points
    /// outwards.
    Entering,
    /// Along it.
    Leaving,
}

/// Which side of the triangle the ray's line crosses, whatever its range of t; `None` where it doesn't cross it.
pub fn crossed(ray: &Ray, corners: &Corners) -> Option<Side> {
    let direction = ray.direction.to_array();
    let up = corners.map(|corner| height(direction, ray.origin, corner).is_gt());
    let mut side = None;
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        if up[i] == up[j] {
            continue;
        }
        let (low, high) = if up[j] { (i, j) } else { (j, i) };
        if edge(ray, corners[low], corners[high]).is_gt() {
            // Of the two edges that cross the plane, both on this side means beside the triangle.
            side = match side {
                None => Some(if up[i] { Side::Entering } else { Side::Leaving }),
                Some(_) => None,
            };
        }
    }
    side
}

/// Where a point is relative to a closed mesh, given all triangles that the ray from it along x may meet.
///
/// # Panics
/// If there is no such triangle.
pub fn locate(mesh: MeshRef, candidates: impl IntoIterator<Item = u32>, point: Vec3) -> Location {
    let ray = Ray::new(point, Vec3::X);
    let mut inside = false;
    for id in candidates {
        let corners = mesh.corners(id as usize);
        let above = orientation(point, &corners);
        if above.is_eq() && holds(&corners, point) {
            return Location::Surface;
        }
        let ahead = match crossed(&ray, &corners) {
            Some(Side::Entering) => above.is_gt(),
            Some(Side::Leaving) => above.is_lt(),
            None => false,
        };
        inside ^= ahead;
    }
    if inside { Location::Inside } else { Location::Outside }
}

/// Where a point is relative to the closed mesh that a structure was built for rays of any kind over; `None` if the structure
/// doesn't name [`Accel::candidates`].
pub fn locate_by(accel: &(impl Accel + ?Sized), mesh: MeshRef, point: Vec3) -> Option<Location> {
    let mut candidates = Vec::new();
    let named = accel.candidates(&Ray::new(point, Vec3::X), &mut candidates);
    named.then(|| locate(mesh, candidates, point))
}

/// Above any error of the sums below relative to the sum of their absolute terms: eight roundings.
const BOUND: f64 = 16.0 * f64::EPSILON;

/// The sign of w·(p − o), where w is perpendicular to the direction: above or below a plane through the line.
fn height([dx, dy, dz]: [f32; 3], o: Vec3, p: Vec3) -> Ordering {
    // Perpendicular whichever is chosen, and not zero.
    let (i, j, di, dj) = if dy != 0.0 || dz != 0.0 { (1, 2, dy, dz) } else { (0, 2, dx, dz) };
    // Products of two `f32` are exact.
    let terms = [
        f64::from(di) * f64::from(p[j]),
        -f64::from(di) * f64::from(o[j]),
        -f64::from(dj) * f64::from(p[i]),
        f64::from(dj) * f64::from(o[i]),
    ];
    let value: f64 = terms.iter().sum();
    let size: f64 = terms.iter().map(|term| term.abs()).sum();
    if value.abs() > size * BOUND {
        return sign(value);
    }
    let mut sum = Expansion::<8>::ZERO;
    terms.into_iter().for_each(|term| sum.add(term));
    sum.sign()
}

/// The sign of d·((p − o) × (q − o)).
fn edge(ray: &Ray, p: Vec3, q: Vec3) -> Ordering {
    let (o, d) = (ray.origin, ray.direction);
    let near = determinant(d.as_dvec3(), p.as_dvec3() - o.as_dvec3(), q.as_dvec3() - o.as_dvec3());
    near.unwrap_or_else(|| {
        let mut sum = Expansion::<36>::ZERO;
        triple(&mut sum, d, p, q);
        triple(&mut sum, d, p, -o);
        triple(&mut sum, d, -o, q);
        sum.sign()
    })
}

/// On which side of the triangle's plane a point is: greater on that of the normal.
fn orientation(point: Vec3, corners: &Corners) -> Ordering {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3() - point.as_dvec3());
    let below = determinant(a, b, c).unwrap_or_else(|| {
        let [a, b, c] = *corners;
        let mut sum = Expansion::<48>::ZERO;
        triple(&mut sum, a, b, c);
        triple(&mut sum, -point, b, c);
        triple(&mut sum, a, -point, c);
        triple(&mut sum, a, b, -point);
        sum.sign()
    });
    below.reverse()
}

/// Whether a point of the triangle's plane lies in the closed triangle: seen along an axis along which the plane doesn't lie.
fn holds(corners: &Corners, point: Vec3) -> bool {
    let [a, b, c] = *corners;
    Vec3::AXES.into_iter().any(|axis| {
        let ray = Ray::new(point, axis);
        let signs = [edge(&ray, a, b), edge(&ray, b, c), edge(&ray, c, a)];
        signs.contains(&Ordering::Less) != signs.contains(&Ordering::Greater)
    })
}

/// The sign of a·(b × c), where differences of `f32` stand in some of them, if that is certain.
fn determinant(a: glam::DVec3, b: glam::DVec3, c: glam::DVec3) -> Option<Ordering> {
    let (mut value, mut size) = (0.0, 0.0);
    for [i, j, k] in MINORS {
        let (x, y) = (b[j] * c[k], b[k] * c[j]);
        value += a[i] * (x - y);
        size += a[i].abs() * (x.abs() + y.abs());
    }
    (value.abs() > size * BOUND).then(|| sign(value))
}

#[cfg(test)]
mod tests;
