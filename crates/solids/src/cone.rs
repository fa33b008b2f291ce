//! Cones and cylinders.

use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use crate::quadratic::{clipped, ranges_below, to_vertex};
use accel::Ray;
use accel::solid::{Cone, Shape};

/// Between the two ends of the slab of its caps, where the distance from the axis, squared, is not above the square of the radius
/// there (cf. P. Schneider, D. Eberly 2003, "Geometric Tools for Computer Graphics", §11.3.4). Being convex, the
/// object is crossed in one range.
impl FewCrossings<2> for Cone {
    fn few(&self, ray: &Ray) -> Few<2> {
        let (base, top) = (self.base.as_dvec3(), self.top.as_dvec3());
        let Some(line) = Local::of(&self.bounds(), (base + top) * 0.5, ray) else { return Few::NONE };
        let line = line.centered();
        let height = (top - base).length();
        let axis = (top - base) / height;
        let (low, high) = (f64::from(self.base_radius), f64::from(self.top_radius));
        let slope = (high - low) / height;
        let dh = line.direction.dot(axis);
        let (d, dr) = (line.direction - axis * dh, slope * dh);
        let a = d.dot(d) - dr * dr;
        let at = |line: &Local| {
            let h = line.origin.dot(axis);
            (h, line.origin - axis * h, 0.5 * (low + high) + slope * h)
        };
        let (_, o, r) = at(&line);
        let reach = (height + low + high) / line.direction.length();
        let line = line.from(to_vertex(a, o.dot(d) - r * dr, reach));
        let (h, o, r) = at(&line);
        let slab = match dh == 0.0 {
            true if h.abs() * 2.0 > height => return Few::NONE,
            true => (f64::NEG_INFINITY, f64::INFINITY),
            false => {
                let (a, b) = ((-0.5 * height - h) / dh, (0.5 * height - h) / dh);
                (a.min(b), a.max(b))
            }
        };
        let (b, c) = (o.dot(d) - r * dr, o.dot(o) - r * r);
        // What opens downward has roots, which may be one at the tip.
        let c = if a < 0.0 && b * b - a * c < 0.0 { 0.0 } else { c };
        let ranges = ranges_below(a, b, c);
        // The other of two ranges is in the mirrored cone beyond the tip, which at most touches the slab.
        let [a, b] = ranges.map(|range| clipped(range, slab));
        let (enters, leaves) = if b.1 - b.0 > a.1 - a.0 { b } else { a };
        if enters <= leaves && leaves - enters < f64::INFINITY {
            return Few::chord(line.moved + enters, line.moved + leaves);
        }
        Few::NONE
    }
}

crossings_by_few!(Cone);
