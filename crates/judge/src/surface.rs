//! How far a point is from a triangle.

use accel::Corners;

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The distance between two points.
pub fn between(a: Point, b: Point) -> f64 {
    let d = minus(a, b);
    dot(d, d).sqrt()
}

/// The point of the segment from `a` to `b` nearest to `p`.
fn nearest_on(a: Point, b: Point, p: Point) -> Point {
    let along = minus(b, a);
    let length = dot(along, along);
    let share = if length > 0.0 { (dot(minus(p, a), along) / length).clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + along[0] * share, a[1] + along[1] * share, a[2] + along[2] * share]
}

/// The distance of a point from a triangle: from its plane where the foot is inside, else from the nearest edge.
pub fn distance(p: Point, triangle: &Corners) -> f64 {
    let [a, b, c] = triangle.map(|corner| corner.as_dvec3().to_array());
    let (e1, e2, ap) = (minus(b, a), minus(c, a), minus(p, a));
    let normal =
        [e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]];
    let area = dot(normal, normal);
    if area > 0.0 {
        let cross = |a: Point, b: Point| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let (u, v) = (dot(cross(ap, e2), normal) / area, dot(cross(e1, ap), normal) / area);
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
            return (dot(ap, normal) / area.sqrt()).abs();
        }
    }
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .map(|(a, b)| between(nearest_on(a, b, p), p))
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;

    #[test]
    fn faces_edges_corners_and_slivers() {
        let triangle = [Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0];
        assert_eq!(distance([1.0, 1.0, 3.0], &triangle), 3.0);
        assert_eq!(distance([1.0, -2.0, 0.0], &triangle), 2.0);
        assert_eq!(distance([-3.0, -4.0, 0.0], &triangle), 5.0);
        let line = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0];
        assert_eq!(distance([1.5, 2.0, 0.0], &line), 2.0);
        assert_eq!(distance([0.0, 2.0, 0.0], &[Vec3::ZERO; 3]), 2.0);
        let huge = triangle.map(|corner| corner * 2f32.powi(120));
        assert_eq!(distance([1.0, 1.0, 2f64.powi(121)], &huge), 2f64.powi(121));
    }
}
