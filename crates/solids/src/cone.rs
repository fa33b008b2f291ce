//! Cones and cylinders.

use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use crate::quadratic::{clipped, ranges_below};
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
        let (h, dh) = (line.origin.dot(axis), line.direction.dot(axis));
        let slab = match dh == 0.0 {
            true if h.abs() * 2.0 > height => return Few::NONE,
            true => (f64::NEG_INFINITY, f64::INFINITY),
            false => {
                let (a, b) = ((-0.5 * height - h) / dh, (0.5 * height - h) / dh);
                (a.min(b), a.max(b))
            }
        };
        let (low, high) = (f64::from(self.base_radius), f64::from(self.top_radius));
        let slope = (high - low) / height;
        let (r, dr) = (0.5 * (low + high) + slope * h, slope * dh);
        let (o, d) = (line.origin - axis * h, line.direction - axis * dh);
        let ranges = ranges_below(d.dot(d) - dr * dr, o.dot(d) - r * dr, o.dot(o) - r * r);
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
