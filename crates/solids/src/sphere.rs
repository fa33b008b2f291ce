//! Balls.

use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use accel::Ray;
use accel::solid::{Shape, Sphere};

/// In the form that keeps digits far away: the discriminant from the vector between the centre and the line's nearest point,
/// and the smaller root from the product of both (E. Haines, J. Günther, T. Akenine-Möller 2019, "Precision
/// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, ch. 7).
impl FewCrossings<2> for Sphere {
    fn few(&self, ray: &Ray) -> Few<2> {
        let Some(line) = Local::of(&self.bounds(), self.center.as_dvec3(), ray) else { return Few::NONE };
        let (f, d) = (line.origin, line.direction);
        let radius = f64::from(self.radius);
        let (a, b) = (d.dot(d), -f.dot(d));
        let aside = f + d * (b / a);
        let square = radius * radius - aside.dot(aside);
        // Also where the direction is zero or not finite.
        if square.is_nan() || square < 0.0 {
            return Few::NONE;
        }
        let q = b + (a * square).sqrt().copysign(b);
        let (first, second) = ((f.dot(f) - radius * radius) / q, q / a);
        let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (first.min(second), first.max(second)) };
        Few::chord(line.moved + first, line.moved + second)
    }
}

crossings_by_few!(Sphere);

#[cfg(test)]
mod tests {
    use crate::Crossings;
    use crate::tests::crossings;
    use accel::solid::Sphere;
    use accel::{Ray, Vec3};

    #[test]
    fn a_ball_is_entered_and_left() {
        let ball = Sphere { center: Vec3::new(5.0, 1.0, 2.0), radius: 2.0 };
        let ray = Ray::new(Vec3::new(0.0, 1.0, 2.0), Vec3::X * 0.5);
        assert_eq!(crossings(&ball, &ray), [(6.0, true), (14.0, false)]);
        let from_inside = Ray { t_min: 7.0, ..ray };
        assert_eq!(crossings(&ball, &from_inside), [(14.0, false)]);
        assert_eq!(ball.nearest(&from_inside, 13.0), None);
        assert_eq!(ball.nearest(&ray, 6.0).map(|s| s.t), Some(6.0));
        let beside = Ray { origin: Vec3::new(0.0, 3.5, 2.0), ..ray };
        assert_eq!(crossings(&ball, &beside), []);
        let touching = Ray { origin: Vec3::new(0.0, 3.0, 2.0), ..ray };
        assert_eq!(crossings(&ball, &touching), [(10.0, true), (10.0, false)]);
    }

    #[test]
    fn digits_are_kept_far_away_and_at_any_scale() {
        for power in [-60, -20, 0, 20, 60] {
            let unit = 2f32.powi(power);
            let ball = Sphere { center: Vec3::new(3.0, -1.0, 0.5) * unit, radius: unit };
            for away in [1u32, 20, 40, 60].map(|p| 2f32.powi(p as i32)) {
                let ray = Ray::new(Vec3::new(-away, -1.0, 0.5) * unit, Vec3::X * unit);
                let [(enters, _), (leaves, _)] = crossings(&ball, &ray)[..] else { panic!("{power} {away}") };
                assert_eq!(enters as f32, away + 2.0, "{power} {away}");
                assert_eq!(leaves as f32, away + 4.0, "{power} {away}");
            }
        }
    }
}
