//! Triangles as one kind among others.

use crate::Crossing;
use crate::crossing::{Few, FewCrossings, crossings_by_few};
use crate::local::Local;
use accel::solid::Shape;
use accel::{Corners, Ray};

/// In `f64` (T. Möller, B. Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection").
impl FewCrossings<1> for Corners {
    fn few(&self, ray: &Ray) -> Few<1> {
        let corners = self.map(|corner| corner.as_dvec3());
        let Some(line) = Local::of(&self.bounds(), corners[0], ray) else { return Few::NONE };
        let (edge1, edge2) = (corners[1] - corners[0], corners[2] - corners[0]);
        let p = line.direction.cross(edge2);
        let det = edge1.dot(p);
        let inverse = 1.0 / det;
        let u = line.origin.dot(p) * inverse;
        let q = line.origin.cross(edge1);
        let v = line.direction.dot(q) * inverse;
        let mut few = Few::NONE;
        // No comparison holds where the determinant is zero.
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
            let t = line.moved + edge2.dot(q) * inverse;
            few.push(Crossing { t, enters: det > 0.0, u: u as f32, v: v as f32 });
        }
        few
    }
}

crossings_by_few!(Corners);

#[cfg(test)]
mod tests {
    use crate::Crossings;
    use accel::{Ray, Vec3};

    #[test]
    fn a_front_is_entered_and_a_back_left() {
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let mut out = Vec::new();
        triangle.crossings(&Ray::new(Vec3::new(0.25, 0.5, 2.0), Vec3::NEG_Z), &mut out);
        triangle.crossings(&Ray::new(Vec3::new(0.25, 0.5, -3.0), Vec3::Z), &mut out);
        triangle.crossings(&Ray::new(Vec3::new(0.75, 0.5, -3.0), Vec3::Z), &mut out);
        let told: Vec<_> = out.iter().map(|c| (c.t, c.enters, c.u, c.v)).collect();
        assert_eq!(told, [(2.0, true, 0.25, 0.5), (3.0, false, 0.25, 0.5)]);
    }
}
