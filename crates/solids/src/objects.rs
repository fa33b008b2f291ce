//! Solids as the objects of a scene.

use crate::{Crossing, Crossings};
use accel::tolerance::{holds, pad_of};
use accel::{Aabb, Hit, Objects, Ray, Solid, Surface};
use lanes::Unpacked;

/// The solids of a scene, of any kinds.
#[derive(Clone, Copy, Debug)]
pub struct Solids<'s> {
    solids: &'s [Solid],
    pad: f32,
}

impl<'s> Solids<'s> {
    /// The objects of a scene of solids, which are valid.
    pub fn new(solids: &'s [Solid]) -> Self {
        let bounds = solids.iter().fold(Aabb::EMPTY, |all, solid| all.union(solid.bounds()));
        Self { solids, pad: pad_of(&bounds) }
    }

    /// Appends every crossing of an object in the ray's range that satisfies the hit-in-padded-bounds invariant, in order.
    ///
    /// # Panics
    /// If there is no such object.
    pub fn crossings(&self, id: u32, ray: &Ray, out: &mut Vec<Crossing>) {
        let (first, bounds) = (out.len(), self.bounds(id));
        self.solids[id as usize].crossings(ray, out);
        let mut at = 0;
        out.retain(|crossing| {
            at += 1;
            at <= first || holds(&bounds, ray, crossing.t as f32)
        });
    }
}

impl Objects for Solids<'_> {
    fn len(&self) -> usize {
        self.solids.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.solids[id as usize].bounds().padded(self.pad)
    }

    #[inline]
    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        let hit = self.solids[id as usize].nearest(ray, t_max)?;
        holds(&self.bounds(id), ray, hit.t).then_some(hit)
    }

    fn crossings(&self, id: u32, ray: &Ray, found: &mut Vec<Hit>) {
        let mut all = Vec::new();
        Self::crossings(self, id, ray, &mut all);
        let hit = |Surface { t, u, v }| Hit { t, object: id, u, v };
        found.extend(all.iter().map(|crossing| hit(crossing.surface())));
    }
}

impl Unpacked for Solids<'_> {}
