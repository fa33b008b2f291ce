//! Closed meshes as one object.

use crate::local::Local;
use crate::{Crossing, Crossings};
use accel::Ray;
use accel::parity::{Side, crossed};
use accel::solid::{Facets, Shape};

/// Which facets are crossed, and from which side, is told without error ([`accel::parity`]), so that every line enters as often as
/// it leaves; where, is told in `f64`.
impl Crossings for Facets {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let bounds = self.bounds();
        let center = bounds.center().as_dvec3();
        let Some(line) = Local::of(&bounds, center, ray) else { return };
        let first = out.len();
        self.visit(
            |bounds| bounds.overlap(ray.origin, ray.direction).is_some(),
            |corners| {
                let Some(side) = crossed(ray, &corners) else { return };
                let [a, b, c] = corners.map(|corner| corner.as_dvec3() - center);
                let normal = (b - a).cross(c - a);
                // Where the facet is seen edge-on, t may be anything within the box.
                let t =
                    ((a - line.origin).dot(normal) / line.direction.dot(normal)).clamp(line.near, line.far);
                let crossing = Crossing::at(line.moved + t, side == Side::Entering);
                if crossing.within(ray, ray.t_max) {
                    out.push(crossing);
                }
            },
        );
        // Ways in before ways out at the same place, so that whoever counts is never outside between them.
        out[first..].sort_by(|a, b| a.t.total_cmp(&b.t).then(b.enters.cmp(&a.enters)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Mesh, Vec3};
    use std::sync::Arc;

    /// An octahedron.
    fn octahedron() -> Facets {
        let positions = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|p| [p, -p]).collect();
        let mut triangles = Vec::new();
        for x in [0, 1] {
            for y in [2, 3] {
                for z in [4, 5] {
                    triangles.push(if (x + y + z) % 2 == 0 { [x, y, z] } else { [x, z, y] });
                }
            }
        }
        Facets::new(Arc::new(Mesh { positions, triangles }))
    }

    #[test]
    fn corners_and_edges_are_passed_once() {
        let facets = octahedron();
        assert_eq!(facets.validate(), Ok(()));
        let crossings = |origin: Vec3, to: Vec3| {
            let mut out = Vec::new();
            facets.crossings(&Ray { t_min: -1e6, ..Ray::new(origin, to - origin) }, &mut out);
            out.iter().map(|c| (c.t, c.enters)).collect::<Vec<_>>()
        };
        assert_eq!(crossings(Vec3::X * -3.0, Vec3::X * -2.0), [(2.0, true), (4.0, false)]);
        assert_eq!(
            crossings(Vec3::new(-2.0, 0.5, 0.0), Vec3::new(-1.0, 0.5, 0.0)),
            [(1.5, true), (2.5, false)]
        );
        let mut random = accel::testing::random(11);
        let mut point = || Vec3::new(random(), random(), random());
        for _ in 0..2000 {
            let (a, b) = (point() * 2.0, point());
            let found = crossings(a, b);
            assert!(found.len() % 2 == 0 && found.chunks(2).all(|pair| pair[0].1 && !pair[1].1), "{found:?}");
        }
    }
}
