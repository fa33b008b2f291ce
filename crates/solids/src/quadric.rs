//! Quadrics in general position.

use crate::Crossing;
use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use crate::quadratic::{clipped, ranges_below};
use accel::Ray;
use accel::solid::Quadric;

/// Where F ≤ 0 along the line, which is of the second degree, within the box.
impl FewCrossings<4> for Quadric {
    fn few(&self, ray: &Ray) -> Few<4> {
        let mut few = Few::NONE;
        let Some(line) = Local::of(&self.bounds, self.center(), ray) else { return few };
        let line = line.centered();
        let (o, d) = (line.origin, line.direction);
        let along = self.half_gradient(o + d) - self.half_gradient(o);
        let along = along.dot(d);
        let (b, c) = (self.half_gradient(o).dot(d), self.value(o));
        for range in ranges_below(along, b, c) {
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
