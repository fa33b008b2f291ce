//! The methods the paper measures BMSSM against: a bounding volume for each object,
//! tested for every ray, and detail tests of what remains (Skala 1993, §2–4).

use accel::tolerance::{BALL, T_SLACK};
use accel::{
    Aabb, Accel, BuildError, Builder, Count, Counters, Footprint, Hit, Nearest, NoCount, Objects, Ray,
    RaySet, Scene, Vec3, Workload, vec_bytes,
};
use lanes::PackedObjects;
use primitives::{KernelId, WithObjects};

/// Builds `minmax`: every object's box tested for every ray.
#[derive(Clone, Copy, Debug)]
pub struct MinMax {
    /// The ray-triangle test.
    pub kernel: KernelId,
}

/// Builds `sphere`: every object's bounding sphere tested for every ray.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// The ray-triangle test.
    pub kernel: KernelId,
}

/// A bounding volume.
trait Volume: Copy + Send + Sync {
    const NAME: &'static str;
    fn of(bounds: &Aabb) -> Self;
    /// Whether the ray may meet the volume at t in its range up to `t_max`; never wrongly "no".
    fn may_meet(&self, ray: &Ray, t_max: f32) -> bool;
}

impl Volume for Aabb {
    const NAME: &'static str = "boxes";

    fn of(bounds: &Aabb) -> Self {
        *bounds
    }

    #[inline]
    fn may_meet(&self, ray: &Ray, t_max: f32) -> bool {
        self.overlap(ray.origin, ray.direction).is_some_and(|(near, far)| {
            let slack = T_SLACK * near.abs().max(far.abs());
            near - slack <= f64::from(t_max) && far + slack >= f64::from(ray.t_min)
        })
    }
}

#[derive(Clone, Copy)]
struct Ball {
    center: Vec3,
    radius: f32,
}

impl Volume for Ball {
    const NAME: &'static str = "spheres";

    fn of(bounds: &Aabb) -> Self {
        let center = bounds.center();
        let corner = |a: usize| {
            let c = f64::from(center[a]);
            (f64::from(bounds.max[a]) - c).max(c - f64::from(bounds.min[a]))
        };
        let radius = (corner(0).powi(2) + corner(1).powi(2) + corner(2).powi(2)).sqrt();
        Self { center, radius: (radius as f32).next_up() }
    }

    /// Distance of the line from the centre, as in Skala 1993, §4, in `f64`; the range of t is left to the
    /// detail test, as in the paper.
    #[inline]
    fn may_meet(&self, ray: &Ray, _: f32) -> bool {
        let c = self.center.as_dvec3() - ray.origin.as_dvec3();
        let d = ray.direction.as_dvec3();
        let foot = c.dot(d) / d.length_squared();
        let r = f64::from(self.radius);
        let rounding = BALL * (r * r + c.length_squared());
        (c - d * foot).length_squared() <= r * r + rounding
    }
}

struct Built<O, V> {
    objects: O,
    volumes: Vec<V>,
}

impl<O: Objects, V: Volume> Built<O, V> {
    fn nearest<C: Count>(&self, ray: &Ray, count: &mut C) -> Nearest {
        let mut best = Nearest::new(ray.t_max);
        count.candidates(self.volumes.len() as u64);
        for (id, volume) in (0..).zip(&self.volumes) {
            if volume.may_meet(ray, best.t) {
                count.tests(1);
                self.objects.closest(id, ray, &mut best);
            }
        }
        best
    }
}

impl<O: Objects, V: Volume> Accel for Built<O, V> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.nearest(ray, &mut NoCount).hit()
    }

    fn occluded(&self, ray: &Ray) -> bool {
        (0..).zip(&self.volumes).any(|(id, volume)| {
            volume.may_meet(ray, ray.t_max) && self.objects.intersect(id, ray, ray.t_max).is_some()
        })
    }

    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        found.extend(
            (0..).zip(&self.volumes).filter(|(_, volume)| volume.may_meet(ray, ray.t_max)).map(|(id, _)| id),
        );
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of(self, &self.objects, ray)
    }

    fn footprint(&self) -> Footprint {
        Footprint::default().structure(V::NAME, vec_bytes(&self.volumes))
    }

    fn count(&self, rays: &RaySet, _: bool) -> Option<Counters> {
        let mut counters = Counters::default();
        for i in 0..rays.len() {
            self.nearest(&rays.ray(i), &mut counters);
        }
        Some(counters)
    }
}

struct Build<V>(std::marker::PhantomData<V>);

impl<'s, V: Volume + 's> WithObjects<'s> for Build<V> {
    type Out = Box<dyn Accel + 's>;
    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        let volumes = (0..objects.len() as u32).map(|id| V::of(&objects.bounds(id))).collect();
        Box::new(Built::<O, V> { objects, volumes })
    }
}

macro_rules! builder {
    ($name:ident, $id:literal, $volume:ty) => {
        impl Builder for $name {
            fn id(&self) -> &str {
                $id
            }

            fn settings(&self) -> String {
                format!("kernel={}", self.kernel)
            }

            fn build<'s>(&self, scene: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
                Ok(primitives::with_objects(scene, self.kernel, Build::<$volume>(std::marker::PhantomData)))
            }
        }
    };
}

builder!(MinMax, "minmax", Aabb);
builder!(Sphere, "sphere", Ball);
