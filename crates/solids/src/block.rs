//! Boxes as one kind among others.

use crate::crossing::{Few, FewCrossings, crossings_by_few};
use accel::{Aabb, Ray};

impl FewCrossings<2> for Aabb {
    fn few(&self, ray: &Ray) -> Few<2> {
        match self.overlap(ray.origin, ray.direction) {
            Some((near, far)) => Few::chord(near, far),
            None => Few::NONE,
        }
    }
}

crossings_by_few!(Aabb);
