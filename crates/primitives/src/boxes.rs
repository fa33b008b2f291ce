//! Axis-aligned boxes as objects: the paper's experiment.

use accel::Objects;
use accel::tolerance::pad_of;
use accel::{Aabb, Hit, Ray, Surface};
use lanes::Unpacked;

/// Solid axis-aligned boxes. A ray from outside hits where it enters, a ray from inside
/// where it leaves; u and v are 0.
#[derive(Clone, Copy, Debug)]
pub struct Boxes<'s> {
    boxes: &'s [Aabb],
    pad: f32,
}

impl<'s> Boxes<'s> {
    /// The objects of a scene of boxes.
    pub fn new(boxes: &'s [Aabb]) -> Self {
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b));
        Self { boxes, pad: pad_of(&bounds) }
    }
}

impl Objects for Boxes<'_> {
    fn len(&self) -> usize {
        self.boxes.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.boxes[id as usize].padded(self.pad)
    }

    #[inline]
    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        let (near, far) = self.boxes[id as usize].overlap(ray.origin, ray.direction)?;
        [near as f32, far as f32]
            .into_iter()
            .find(|t| *t >= ray.t_min)
            .filter(|t| *t <= t_max)
            .map(|t| Surface { t, u: 0.0, v: 0.0 })
    }

    /// Where the ray enters and where it leaves, at the same t too.
    fn crossings(&self, id: u32, ray: &Ray, found: &mut Vec<Hit>) {
        let Some((near, far)) = self.boxes[id as usize].overlap(ray.origin, ray.direction) else { return };
        let there = |t: &f32| ray.t_min <= *t && *t <= ray.t_max;
        let ends = [near as f32, far as f32].into_iter().filter(there);
        found.extend(ends.map(|t| Hit { t, object: id, u: 0.0, v: 0.0 }));
    }
}

impl Unpacked for Boxes<'_> {}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;

    #[test]
    fn a_ray_from_inside_hits_where_it_leaves() {
        let boxes = [Aabb { min: Vec3::ZERO, max: Vec3::ONE }];
        let objects = Boxes::new(&boxes);
        let t = |origin| {
            let ray = Ray::new(Vec3::new(origin, 0.5, 0.5), Vec3::X);
            objects.intersect(0, &ray, f32::INFINITY).map(|s| s.t)
        };
        assert_eq!(t(-1.0), Some(1.0));
        assert_eq!(t(0.25), Some(0.75));
        assert_eq!(t(1.5), None);
    }
}
