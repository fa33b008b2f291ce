//! Objects of others' making.

use accel::input::{InputError, check_extent};
use accel::tolerance::{holds, pad_of};
use accel::{Aabb, Hit, Objects, Ray, Surface};
use lanes::Unpacked;

/// Objects of any kind, held to what structures rely on: boxes are padded, and a hit outside of its object's
/// padded box is none.
#[derive(Debug)]
pub struct Guarded<'s, O> {
    objects: &'s O,
    pad: f32,
}

impl<O> Clone for Guarded<'_, O> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<O> Copy for Guarded<'_, O> {}

impl<'s, O: Objects> Guarded<'s, O> {
    /// Looks at the box of each object.
    ///
    /// # Errors
    /// [`InputError`] names the first object whose box is empty or not finite, or says that the objects reach too far or are too
    /// many.
    pub fn new(objects: &'s O) -> Result<Self, InputError> {
        if objects.len() >= u32::MAX as usize {
            return Err(InputError::TooMany(objects.len()));
        }
        let mut all = Aabb::EMPTY;
        for object in 0..objects.len() {
            let bounds = objects.bounds(object as u32);
            if bounds.is_empty() || !bounds.min.is_finite() || !bounds.max.is_finite() {
                return Err(InputError::Bounds { object, bounds });
            }
            all = all.union(bounds);
        }
        check_extent(all)?;
        Ok(Self { objects, pad: pad_of(&all) })
    }
}

impl<O: Objects> Objects for Guarded<'_, O> {
    fn len(&self) -> usize {
        self.objects.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.objects.bounds(id).padded(self.pad)
    }

    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        let hit = self.objects.intersect(id, ray, t_max)?;
        let within = ray.t_min <= hit.t && hit.t <= t_max && holds(&self.bounds(id), ray, hit.t);
        within.then_some(hit)
    }

    fn crossings(&self, id: u32, ray: &Ray, found: &mut Vec<Hit>) {
        let first = found.len();
        self.objects.crossings(id, ray, found);
        let bounds = self.bounds(id);
        let mut at = first;
        found.retain(|hit| {
            at += 1;
            let within = ray.t_min <= hit.t && hit.t <= ray.t_max && hit.object == id;
            at <= first || within && holds(&bounds, ray, hit.t)
        });
    }
}

impl<O: Objects> Unpacked for Guarded<'_, O> {}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;

    /// A point each, hit by every ray at the same t.
    #[derive(Debug)]
    struct Points(Vec<Vec3>, f32);

    impl Objects for Points {
        fn len(&self) -> usize {
            self.0.len()
        }

        fn bounds(&self, id: u32) -> Aabb {
            Aabb::of_points([self.0[id as usize]])
        }

        fn intersect(&self, _: u32, _: &Ray, _: f32) -> Option<Surface> {
            Some(Surface { t: self.1, u: 0.0, v: 0.0 })
        }
    }

    #[test]
    fn hits_outside_of_an_objects_box_are_none() {
        let hits = |t: f32, t_max: f32| {
            let points = Points(vec![Vec3::ZERO, Vec3::X], t);
            let ray = Ray::new(Vec3::NEG_Z, Vec3::Z);
            let objects = Guarded::new(&points).unwrap();
            [0, 1].map(|id| objects.intersect(id, &ray, t_max).is_some())
        };
        assert_eq!(hits(1.0, f32::INFINITY), [true, false]);
        assert_eq!(hits(1.1, f32::INFINITY), [false, false]);
        assert_eq!(hits(1.0, 0.9), [false, false]);
        assert_eq!(hits(f32::NAN, f32::INFINITY), [false, false]);
    }

    #[test]
    fn boxes_that_are_none_are_named() {
        let error = Guarded::new(&Points(vec![Vec3::ZERO, Vec3::NAN], 1.0)).unwrap_err();
        assert!(matches!(error, InputError::Bounds { object: 1, .. }), "{error}");
        let error = Guarded::new(&Points(vec![Vec3::splat(-3e38), Vec3::splat(3e38)], 1.0)).unwrap_err();
        assert!(matches!(error, InputError::Extent { .. }), "{error}");
    }
}
