//! Cameras for scenes that bring none.

use accel::{Aabb, Geometry, Vec3, View};
use glam::DVec3;

/// Full vertical angle of view in degrees of cameras of which nothing is told.
pub const FOV: f32 = 45.0;

/// A camera that sees the whole geometry from above one corner.
pub fn framing(geometry: &Geometry) -> View {
    let bounds = bounds(geometry);
    let center = (bounds.min.as_dvec3() + bounds.max.as_dvec3()) * 0.5;
    let radius = radius(&bounds);
    // A sphere fills the view from a distance of radius / sin(fov / 2).
    let distance = radius / libm::sin(f64::from(FOV).to_radians() * 0.5);
    let towards = DVec3::new(0.55, -0.7, 0.45).normalize();
    View {
        eye: (center + towards * distance).as_vec3(),
        target: center.as_vec3(),
        up: Vec3::Z,
        fov_y_degrees: FOV,
    }
}

/// The geometry's bounds; the unit cube where there is none.
fn bounds(geometry: &Geometry) -> Aabb {
    let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    if geometry.is_empty() { unit } else { geometry.bounds() }
}

/// Half the diagonal. A scene of one point, or one too small beside its offset, still needs a distance.
fn radius(bounds: &Aabb) -> f64 {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let center = (min + max) * 0.5;
    (0.5 * (max - min)).length().max(min_radius(center))
}

fn min_radius(center: DVec3) -> f64 {
    (center.length() * 1e-6).max(1e-30)
}

/// A camera that sees the whole geometry upright, from the right, above and before it, as near as a
/// square picture allows; `up` is what points up in it.
pub fn upright(geometry: &Geometry, up: Vec3, fov_y_degrees: f32) -> View {
    let up = up.as_dvec3().normalize_or(DVec3::Y);
    let beside = if up.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    let side = (beside - up * beside.dot(up)).normalize();
    let front = side.cross(up);
    let forward = -(side * 0.55 + up * 0.45 + front * 0.7).normalize();
    let right = forward.cross(up).normalize();
    let above = right.cross(forward);
    let widening = MARGIN * libm::tan(f64::from(fov_y_degrees).to_radians() * 0.5);

    // In the camera's axes, about the middle: how far each border of the picture must reach, as a plane
    // that opens with depth, and where the nearest point is.
    let bounds = bounds(geometry);
    let center = (bounds.min.as_dvec3() + bounds.max.as_dvec3()) * 0.5;
    let mut reach = [f64::NEG_INFINITY; 4];
    let mut nearest = f64::INFINITY;
    each_corner(geometry, &bounds, |p| {
        let p = p.as_dvec3() - center;
        let (x, y, depth) = (p.dot(right), p.dot(above), p.dot(forward));
        for (reach, across) in reach.iter_mut().zip([x, -x, y, -y]) {
            *reach = reach.max(across - depth * widening);
        }
        nearest = nearest.min(depth);
    });
    let [right_most, left_most, top, bottom] = reach;
    let back = (right_most + left_most).max(top + bottom) / (2.0 * widening);
    // Outside, even of what is flat and seen along its plane, and away from what is but a point.
    let back = back.max(0.02 * radius(&bounds) - nearest).max(4.0 * min_radius(center));
    let middle = center + right * (0.5 * (right_most - left_most)) + above * (0.5 * (top - bottom));
    View {
        eye: (middle - forward * back).as_vec3(),
        target: middle.as_vec3(),
        up: up.as_vec3(),
        fov_y_degrees,
    }
}

/// The part of the picture that the scene fills, across or down.
const MARGIN: f64 = 0.95;

fn each_corner(geometry: &Geometry, bounds: &Aabb, mut see: impl FnMut(Vec3)) {
    match geometry {
        Geometry::Triangles(mesh) if !mesh.triangles.is_empty() => {
            mesh.triangles.iter().flatten().for_each(|i| see(mesh.positions[*i as usize]));
        }
        _ => (0..8).for_each(|corner| {
            let pick =
                |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
            see(Vec3::new(pick(0), pick(1), pick(2)));
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Mesh;

    fn wedge(scale: f32, offset: Vec3) -> Geometry {
        let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [0.5, 3.0, 0.0], [0.0, 0.0, -2.0]];
        let positions = points.map(|p| Vec3::from_array(p) * scale + offset).to_vec();
        Geometry::Triangles(Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]] })
    }

    /// Where in the picture, from −1 to 1, the geometry's borders are: left, right, bottom, top.
    fn borders(geometry: &Geometry, view: &View) -> [f64; 4] {
        let forward = (view.target.as_dvec3() - view.eye.as_dvec3()).normalize();
        let right = forward.cross(view.up.as_dvec3()).normalize();
        let tan = libm::tan(f64::from(view.fov_y_degrees).to_radians() * 0.5);
        let mut out = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        each_corner(geometry, &bounds(geometry), |p| {
            let p = p.as_dvec3() - view.eye.as_dvec3();
            let depth = p.dot(forward) * tan;
            assert!(depth > 0.0);
            let (x, y) = (p.dot(right) / depth, p.dot(right.cross(forward)) / depth);
            out = [out[0].min(x), out[1].max(x), out[2].min(y), out[3].max(y)];
        });
        out
    }

    #[test]
    fn the_scene_fills_the_picture_and_no_more() {
        for scale in [1.0, 1e-20, 1e20] {
            for up in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Y, Vec3::new(1.0, 2.0, 3.0)] {
                let geometry = wedge(scale, Vec3::splat(2.0 * scale));
                let view = upright(&geometry, up, 40.0);
                let [left, right, bottom, top] = borders(&geometry, &view);
                let largest = (right - left).max(top - bottom) * 0.5;
                assert!((largest - MARGIN).abs() < 1e-3, "{up} {left} {right} {bottom} {top}");
                // In the middle along the axis that it fills; nearly so along the other.
                let off = [left + right, bottom + top].map(f64::abs);
                assert!(off[0].min(off[1]) < 1e-3 && off[0].max(off[1]) < 0.3, "{up} {off:?}");
            }
        }
    }

    #[test]
    fn up_is_up_and_the_eye_is_above_and_before() {
        let view = upright(&wedge(1.0, Vec3::ZERO), Vec3::Y, 45.0);
        assert_eq!(view.up, Vec3::Y);
        let towards = view.eye - view.target;
        assert!(towards.x > 0.0 && towards.y > 0.0 && towards.z > 0.0, "{towards}");
        // Z up is seen as the suite's own scenes are.
        let [own, told] = [framing(&wedge(1.0, Vec3::ZERO)), upright(&wedge(1.0, Vec3::ZERO), Vec3::Z, 45.0)];
        let [own, told] = [own, told].map(|view| (view.eye - view.target).normalize());
        assert!(own.distance(told) < 1e-5);
    }

    #[test]
    fn what_has_no_extent_is_seen_from_a_distance() {
        let point = Geometry::Triangles(Mesh { positions: vec![Vec3::ONE], triangles: vec![[0, 0, 0]] });
        let empty = Geometry::Triangles(Mesh { positions: Vec::new(), triangles: Vec::new() });
        for geometry in [point, empty, Geometry::Boxes(Vec::new())] {
            let view = upright(&geometry, Vec3::Y, 45.0);
            assert!(view.eye.is_finite() && view.eye != view.target, "{view:?}");
        }
    }
}
