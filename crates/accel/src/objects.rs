//! What a structure asks of the objects of a scene.

use crate::parallel::prelude::*;
#[cfg(doc)]
use crate::tolerance::T_SLACK;
use crate::{Aabb, Hit, Nearest, Ray, Surface};

/// The boxes of objects: all that most of a build asks for. Every [`Objects`] have them.
pub trait Bounds: Send + Sync {
    /// How many there are.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// [`Objects::bounds`]
    ///
    /// # Panics
    /// If there is no such object.
    fn bounds(&self, id: u32) -> Aabb;

    /// The box of all boxes, empty if there are none.
    fn hull(&self) -> Aabb {
        let each = (0..self.len() as u32).into_par_iter().with_min_len(1 << 12);
        each.map(|id| self.bounds(id)).reduce(|| Aabb::EMPTY, |a, b| a.union(b))
    }
}

impl<O: Objects> Bounds for O {
    #[inline(always)]
    fn len(&self) -> usize {
        Objects::len(self)
    }

    #[inline(always)]
    fn bounds(&self, id: u32) -> Aabb {
        Objects::bounds(self, id)
    }
}

/// The objects of a scene, of any kind: a structure needs their boxes and a detail test
/// (Skala 1993, §1, §7).
///
/// # The hit-in-padded-bounds invariant
/// `intersect` reports a hit at t only if the ray's line meets `bounds(id)` and t lies in
/// the range of that meeting, give or take [`T_SLACK`]`·|t|`. The boxes are padded so that no hit worth having is
/// refused. A structure that never loses an object whose box a ray meets therefore
/// equals brute force bit for bit.
pub trait Objects: Send + Sync {
    /// How many there are, below `u32::MAX`.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The object's padded box: finite, and not empty.
    ///
    /// # Panics
    /// If there is no such object.
    fn bounds(&self, id: u32) -> Aabb;

    /// Where the ray meets the object at t in `[ray.t_min, t_max]`; `ray.t_max` is not looked at.
    ///
    /// # Panics
    /// If there is no such object.
    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface>;

    /// Tests an object and takes its hit if that comes before `best`: at a lower t, or at the same reported t
    /// by number unless the objects can tell their order more exactly.
    ///
    /// # Panics
    /// If there is no such object.
    #[inline]
    fn closest(&self, id: u32, ray: &Ray, best: &mut Nearest) {
        if let Some(surface) = self.intersect(id, ray, best.t) {
            best.offer(id, surface);
        }
    }

    /// Appends every crossing of the ray with the object at t in its range, each of which satisfies the invariant above.
    ///
    /// By default what [`Objects::intersect`] finds, which is all there is of objects that no line meets twice.
    ///
    /// # Panics
    /// If there is no such object.
    fn crossings(&self, id: u32, ray: &Ray, found: &mut Vec<Hit>) {
        let surface = self.intersect(id, ray, ray.t_max);
        found.extend(surface.map(|Surface { t, u, v }| Hit { t, object: id, u, v }));
    }
}
