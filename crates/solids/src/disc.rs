//! Flat discs.

use crate::Crossing;
use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use accel::Ray;
use accel::solid::{Disc, Shape};

/// Where the line meets the disc's plane, no farther from the centre than the radius. A line in the plane meets nothing.
impl FewCrossings<1> for Disc {
    fn few(&self, ray: &Ray) -> Few<1> {
        let mut few = Few::NONE;
        let Some(line) = Local::of(&self.bounds(), self.center.as_dvec3(), ray) else { return few };
        let line = line.centered();
        let normal = self.normal.as_dvec3();
        let along = line.direction.dot(normal);
        let t = -line.origin.dot(normal) / along;
        let radius = f64::from(self.radius);
        // No comparison holds where `along` is zero.
        if (line.origin + line.direction * t).length_squared() <= radius * radius {
            few.push(Crossing::at(line.moved + t, along < 0.0));
        }
        few
    }
}

crossings_by_few!(Disc);
