//! Quadrics in general position.

use crate::Crossing;
use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use crate::quadratic::{clipped, ranges_below, to_vertex};
use accel::Ray;
use accel::solid::Quadric;
use glam::DVec3;

/// Where F ≤ 0 along the line, which is of the second degree, within the box.
impl FewCrossings<4> for Quadric {
    fn few(&self, ray: &Ray) -> Few<4> {
        let mut few = Few::NONE;
        let Some(line) = Local::of(&self.bounds, self.center(), ray) else { return few };
        let line = line.centered();
        let d = line.direction;
        let a = (self.half_gradient(d) - self.half_gradient(DVec3::ZERO)).dot(d);
        let reach = (self.bounds.max - self.bounds.min).as_dvec3().length() / d.length();
        let line = line.from(to_vertex(a, self.half_gradient(line.origin).dot(d), reach));
        let o = line.origin;
        let (b, c) = (self.half_gradient(o).dot(d), self.value(o));
        for range in ranges_below(a, b, c) {
            let (enters, leaves) = clipped(range, (line.near, line.far));
            if enters <= leaves {
                few.push(Crossing::at(line.moved + enters, true));
                few.push(Crossing::at(line.moved + leaves, false));
            }
        }
        few
    }
}

crossings_by_few!(Quadric);
