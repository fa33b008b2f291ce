//! Groups of objects of any kinds.

use crate::{Crossing, Crossings};
use accel::Ray;
use accel::solid::Group;

/// The group's box first, then each part's own.
impl Crossings for Group {
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if self.surroundings().overlap(ray.origin, ray.direction).is_none() {
            return;
        }
        let first = out.len();
        for part in self.parts() {
            part.crossings(ray, out);
        }
        // Parts in their order where they are crossed at one place.
        out[first..].sort_by(|a, b| a.t.total_cmp(&b.t));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solids;
    use accel::solid::{Disc, Sphere};
    use accel::{Objects, Solid, Vec3};

    /// A ball, a disc and a triangle somewhere.
    fn parts(random: &mut impl FnMut() -> f32) -> Vec<Solid> {
        let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
        vec![
            Solid::Sphere(Sphere { center: point(1.0), radius: 0.3 }),
            Solid::Disc(Disc { center: point(1.0), normal: point(1.0), radius: 0.6 }),
            Solid::Triangle([point(1.0), point(1.0), point(1.0)]),
        ]
    }

    #[test]
    fn a_group_is_crossed_where_its_parts_are() {
        let mut random = accel::testing::random(5);
        let mut crossed = 0;
        for _ in 0..300 {
            let (mut all, inner) = (parts(&mut random), parts(&mut random));
            let group = [all.clone(), vec![Solid::Group(Group::new(inner.clone()))]].concat();
            all.extend(inner);
            let group = [Solid::Group(Group::new(group))];
            let (loose, group) = (Solids::in_double(&all), Solids::in_double(&group));
            for _ in 0..20 {
                let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
                let (origin, to) = (point(3.0), point(1.0));
                let ray = Ray::new(origin, to - origin);
                let (mut found, mut expected) = (Vec::new(), Vec::new());
                group.crossings(0, &ray, &mut found);
                (0..all.len() as u32).for_each(|id| loose.crossings(id, &ray, &mut expected));
                expected.sort_by(|a, b| a.t.total_cmp(&b.t));
                assert_eq!(found, expected);
                let nearest = (0..all.len() as u32).filter_map(|id| loose.intersect(id, &ray, 10.0));
                let nearest = nearest.min_by(|a, b| a.t.total_cmp(&b.t));
                assert_eq!(group.intersect(0, &ray, 10.0).map(|hit| hit.t), nearest.map(|hit| hit.t));
                crossed += found.len();
            }
        }
        assert!(crossed > 1000, "{crossed}");
    }
}
