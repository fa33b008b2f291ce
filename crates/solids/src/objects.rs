//! Solids as the objects of a scene.

use crate::exact;
use crate::frame::Frame;
use crate::rows::{Cones, MAX_ROWS, Packing, Spheres, Triangles, one};
use crate::{Crossing, Crossings};
use accel::tolerance::holds;
use accel::{Aabb, Hit, Objects, Ray, Solid, Surface};
use lanes::Scalar;
use lanes::packet::Packet;

/// The solids of a scene, of any kinds.
///
/// Spheres, cones and triangles are tested in single precision, where a ray begins near the scene; everything else in double precision,
/// as [`Crossings`] says.
#[derive(Clone, Copy, Debug)]
pub struct Solids<'s> {
    solids: &'s [Solid],
    pub(crate) frame: Frame,
    precision: Precision,
}

/// What tests are computed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Precision {
    /// `f32` where there are rows and a ray is near, else `f64`.
    Single,
    /// `f64`.
    Double,
    /// As many digits as it takes for spheres, `f64` for others.
    Exact,
}

impl<'s> Solids<'s> {
    /// The objects of a scene of solids, which are valid.
    pub fn new(solids: &'s [Solid]) -> Self {
        let bounds = solids.iter().fold(Aabb::EMPTY, |all, solid| all.union(solid.bounds()));
        Self { solids, frame: Frame::of(&bounds), precision: Precision::Single }
    }

    /// The same with every test in double precision.
    pub fn in_double(solids: &'s [Solid]) -> Self {
        Self { precision: Precision::Double, ..Self::new(solids) }
    }

    /// The same with the true answers for spheres, rounded once: whether a ray hits, and where.
    pub fn exact(solids: &'s [Solid]) -> Self {
        Self { precision: Precision::Exact, ..Self::new(solids) }
    }

    pub(crate) fn precision(&self) -> Precision {
        self.precision
    }

    /// Appends every crossing of an object in the ray's range that satisfies the hit-in-padded-bounds invariant, in order.
    ///
    /// # Panics
    /// If there is no such object.
    pub fn crossings(&self, id: u32, ray: &Ray, out: &mut Vec<Crossing>) {
        let first = out.len();
        match &self.solids[id as usize] {
            Solid::Sphere(sphere) if self.precision == Precision::Exact => {
                let found = exact::crossings(sphere, ray).into_iter().zip([true, false]);
                out.extend(found.filter_map(|(t, enters)| Some(Crossing::at(f64::from(t?), enters))));
            }
            solid => solid.crossings(ray, out),
        }
        let mut at = 0;
        out.retain(|crossing| {
            at += 1;
            at <= first || self.holds(id, ray, crossing.t as f32)
        });
    }

    /// Whether a hit satisfies the hit-in-padded-bounds invariant.
    pub(crate) fn holds(&self, id: u32, ray: &Ray, t: f32) -> bool {
        holds(&self.bounds(id), ray, t)
    }

    /// An object's numbers, if it is of a packed kind.
    pub(crate) fn numbers<K: Packing>(&self, id: u32) -> Option<[f32; MAX_ROWS]> {
        let packed = match self.precision {
            Precision::Single => true,
            Precision::Double => false,
            Precision::Exact => K::HAS_EXACT,
        };
        if packed { K::numbers(&self.solids[id as usize]) } else { None }
    }

    /// An object of kind `K` by the test of rows.
    fn single<K: Packing>(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        let numbers = K::numbers(&self.solids[id as usize])?;
        let (surface, plain) = one::<K>(&numbers, ray, self.frame.pad, t_max)?;
        (plain || self.holds(id, ray, surface.t)).then_some(surface)
    }
}

impl Objects for Solids<'_> {
    fn len(&self) -> usize {
        self.solids.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.solids[id as usize].bounds().padded(self.frame.pad)
    }

    #[inline]
    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        let solid = &self.solids[id as usize];
        let packed = matches!(solid, Solid::Sphere(_) | Solid::Cone(_) | Solid::Triangle(_));
        if packed
            && self.precision == Precision::Single
            && self.frame.near(Scalar, &Packet::splat(Scalar, ray))
        {
            return match solid {
                Solid::Sphere(_) => self.single::<Spheres>(id, ray, t_max),
                Solid::Triangle(_) => self.single::<Triangles>(id, ray, t_max),
                _ => self.single::<Cones>(id, ray, t_max),
            };
        }
        let hit = match solid {
            Solid::Sphere(sphere) if self.precision == Precision::Exact => {
                Surface { t: exact::nearest(sphere, ray, t_max)?, u: 0.0, v: 0.0 }
            }
            _ => solid.nearest(ray, t_max)?,
        };
        self.holds(id, ray, hit.t).then_some(hit)
    }

    fn crossings(&self, id: u32, ray: &Ray, found: &mut Vec<Hit>) {
        let mut all = Vec::new();
        Self::crossings(self, id, ray, &mut all);
        let hit = |Surface { t, u, v }| Hit { t, object: id, u, v };
        found.extend(all.iter().map(|crossing| hit(crossing.surface())));
    }
}
