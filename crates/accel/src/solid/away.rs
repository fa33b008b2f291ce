//! About how far surfaces are away, for points near to them.

use super::implicit::nearest_face;
use super::{Cone, Solid, Torus};
use crate::Aabb;
use glam::{DVec2, DVec3};

/// About how far a point is from a closed solid's surface, up to a factor that tends to 1 near it; `None` of open ones.
pub(super) fn away(solid: &Solid, point: DVec3) -> Option<f64> {
    Some(match solid {
        Solid::Sphere(sphere) => (point.distance(sphere.center.as_dvec3()) - f64::from(sphere.radius)).abs(),
        Solid::Box(bounds) => of_box(bounds, point),
        Solid::Cone(cone) => of_cone(cone, point)?,
        Solid::Torus(torus) => of_torus(torus, point)?,
        Solid::Quadric(quadric) => {
            let at = point - quadric.center();
            of_function(&quadric.bounds, point, quadric.value(at), quadric.half_gradient(at) * 2.0)
        }
        Solid::Implicit(implicit) => {
            let found = implicit.gradient(point);
            of_function(&implicit.bounds, point, found.value, found.slope)
        }
        Solid::Facets(facets) => facets.nearest(point)?.1,
        Solid::Csg(tree) => tree.nearest(point)?.1,
        Solid::Group(group) => group.nearest(point)?.1,
        Solid::Triangle(_) | Solid::Disc(_) | Solid::Patch(_) => return None,
    })
}

fn of_box(bounds: &Aabb, point: DVec3) -> f64 {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let outside = (min - point).max(point - max);
    let beyond = outside.max(DVec3::ZERO).length();
    if beyond > 0.0 { beyond } else { -outside.max_element() }
}

/// Where a function is 0 within a box, or the box's faces where the function is below 0.
fn of_function(bounds: &Aabb, point: DVec3, value: f64, slope: DVec3) -> f64 {
    let zero = value.abs() / slope.length().max(f64::MIN_POSITIVE);
    let (_, face) = nearest_face(bounds, point);
    if value < 0.0 { zero.min(face) } else { zero }
}

/// In the half plane through the axis, a cone is a polygon of three lines.
fn of_cone(cone: &Cone, point: DVec3) -> Option<f64> {
    let (base, top) = (cone.base.as_dvec3(), cone.top.as_dvec3());
    let axis = (top - base).try_normalize()?;
    let along = (point - base).dot(axis);
    let at = DVec2::new((point - base - axis * along).length(), along);
    let low = DVec2::new(f64::from(cone.base_radius), 0.0);
    let high = DVec2::new(f64::from(cone.top_radius), (top - base).length());
    let to = |from: DVec2, to: DVec2| {
        let way = to - from;
        let t = (at - from).dot(way) / way.length_squared();
        at.distance(from + way * if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) })
    };
    Some(to(DVec2::ZERO, low).min(to(low, high)).min(to(DVec2::new(0.0, high.y), high)))
}

fn of_torus(torus: &Torus, point: DVec3) -> Option<f64> {
    let from = point - torus.center.as_dvec3();
    let axis = torus.axis.as_dvec3().try_normalize()?;
    let height = from.dot(axis);
    let flat = (from - axis * height).length() - f64::from(torus.major);
    Some((flat.hypot(height) - f64::from(torus.minor)).abs())
}

#[cfg(test)]
mod tests {
    use super::super::Sphere;
    use super::*;
    use crate::Vec3;

    #[test]
    fn distances_are_those_of_the_nearest_surface() {
        let far = |solid: &Solid, x: f64, y: f64, z: f64| away(solid, DVec3::new(x, y, z)).unwrap();
        let ball = Solid::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
        assert_eq!(far(&ball, 3.0, 0.0, 0.0), 2.0);
        let block = Solid::Box(Aabb { min: Vec3::ZERO, max: Vec3::ONE });
        assert_eq!((far(&block, 0.5, 0.75, 0.5), far(&block, 2.0, 0.5, 0.5)), (0.25, 1.0));
        let cylinder = Cone { base: Vec3::ZERO, base_radius: 1.0, top: Vec3::Z * 2.0, top_radius: 1.0 };
        let cylinder = Solid::Cone(cylinder);
        assert_eq!(far(&cylinder, 0.75, 0.0, 1.0), 0.25);
        assert_eq!(far(&cylinder, 0.5, 0.0, 2.125), 0.125);
        let ring = Torus { center: Vec3::ZERO, axis: Vec3::Z, major: 2.0, minor: 0.5 };
        assert_eq!(far(&Solid::Torus(ring), 2.0, 0.0, 0.0), 0.5);
    }
}
