//! Every crossing of a ray, in order.

use crate::{Accel, Hit, Objects, Ray};

/// The order of crossings: by t, then by object.
fn put_in_order(hits: &mut [Hit]) {
    // What one object reports at one t stays in the order in which the object tells it.
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.object.cmp(&b.object)));
}

/// Every crossing of the ray with these objects, each of which is named once, in order of t, then of object.
///
/// # Panics
/// If there is no such object.
pub fn of_candidates<O: Objects>(
    objects: &O,
    ray: &Ray,
    candidates: impl IntoIterator<Item = u32>,
) -> Vec<Hit> {
    let mut hits = Vec::new();
    for object in candidates {
        objects.crossings(object, ray, &mut hits);
    }
    put_in_order(&mut hits);
    hits
}

/// The crossings of objects that a structure names, see [`Accel::candidates`].
///
/// # Panics
/// If the structure names none, or is of other objects.
pub fn of<O: Objects>(accel: &impl Accel, objects: &O, ray: &Ray) -> Vec<Hit> {
    let mut candidates = Vec::new();
    assert!(accel.candidates(ray, &mut candidates), "the structure names candidates");
    of_candidates(objects, ray, candidates)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aabb, Footprint, Nearest, Surface, Vec3};

    /// Planes z = 0, 1, …
    struct Planes(u32);

    impl Objects for Planes {
        fn len(&self) -> usize {
            self.0 as usize
        }

        fn bounds(&self, id: u32) -> Aabb {
            Aabb { min: Vec3::new(-1.0, -1.0, id as f32), max: Vec3::new(1.0, 1.0, id as f32) }
        }

        fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
            let t = (id as f32 - ray.origin.z) / ray.direction.z;
            (ray.t_min <= t && t <= t_max).then_some(Surface { t, u: 0.0, v: 0.0 })
        }
    }

    impl Accel for Planes {
        fn closest(&self, ray: &Ray) -> Option<Hit> {
            let mut best = Nearest::new(ray.t_max);
            (0..self.0).for_each(|id| Objects::closest(self, id, ray, &mut best));
            best.hit()
        }

        fn footprint(&self) -> Footprint {
            Footprint::default()
        }
    }

    #[test]
    fn crossings_are_in_order_and_within_the_range() {
        let planes = Planes(5);
        let ray = Ray { t_max: 3.0, ..Ray::new(Vec3::new(0.0, 0.0, 4.0), Vec3::NEG_Z) };
        let hits = of_candidates(&planes, &ray, 0..5);
        assert_eq!(
            hits.iter().map(|h| (h.object, h.t)).collect::<Vec<_>>(),
            [(4, 0.0), (3, 1.0), (2, 2.0), (1, 3.0)]
        );
        assert_eq!(planes.all_hits(&ray), hits);
    }
}
