//! Rings.

use crate::Crossing;
use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use crate::polynomial::{Roots, sign_changes};
use accel::Ray;
use accel::solid::{Shape, Torus};

/// With ρ² = |p|² and h its height over the ring's plane, in units of the major radius, the surface is where
/// (ρ² + 1 − r²)² = 4·(ρ² − h²): a polynomial of the fourth degree along the line (P. Hanrahan 1989, "A Survey of Ray–Surface
/// Intersection Algorithms", in An Introduction to Ray Tracing). Its coefficients are taken about the line's point next to the
/// centre, and it is searched where the ball about the ring is.
impl FewCrossings<4> for Torus {
    fn few(&self, ray: &Ray) -> Few<4> {
        let mut few = Few::NONE;
        let Some(line) = Local::of(&self.bounds(), self.center.as_dvec3(), ray) else { return few };
        let line = line.centered();
        let Some(axis) = self.axis.as_dvec3().try_normalize() else { return few };
        let unit = f64::from(self.major);
        let r = f64::from(self.minor) / unit;
        let length = line.direction.length();
        let (o, d) = (line.origin / unit, line.direction / length);
        let (oo, od) = (o.dot(o), o.dot(d));
        let reach = (1.0 + r) * (1.0 + r) - oo;
        if reach.is_nan() || reach < 0.0 {
            return few;
        }
        // Beyond the ball by far more than `od`, which is but rounding.
        let reach = reach.sqrt() * (1.0 + 1e-9) + 1e-9;
        let (h, dh) = (o.dot(axis), d.dot(axis));
        let k = oo + 1.0 - r * r;
        let coefficients = [
            k * k - 4.0 * (oo - h * h),
            4.0 * od * k - 8.0 * od + 8.0 * h * dh,
            4.0 * od * od + 2.0 * k - 4.0 + 4.0 * dh * dh,
            4.0 * od,
            1.0,
        ];
        let mut roots = Roots::default();
        sign_changes(coefficients, -reach, reach, &mut roots);
        let mut enters = true;
        for root in roots.as_slice() {
            few.push(Crossing::at(line.moved + root * (unit / length), enters));
            enters = !enters;
        }
        few
    }
}

crossings_by_few!(Torus);
