//! The judge of a scene's answers.

use crate::surface::{between, distance};
use crate::truth::point;
use crate::{Counts, Errors, Kind, Spread, Tolerance, TrueHit, Truth};
use accel::{Corners, Geometry, Hit, MeshRef, Ray, RaySet, Scene};
use oracle::{Oracle, intersect};
use rayon::prelude::*;

/// Judges answers about a scene of triangles.
#[derive(Debug)]
pub struct Judge<'s> {
    mesh: MeshRef<'s>,
    oracle: Oracle,
    extent: f64,
    tolerance: Tolerance,
}

/// What an answer is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judgement {
    /// What is wrong with it, if anything is.
    pub kind: Option<Kind>,
    /// Distance of the reported point from the true one in extents, where both lie on the same surface.
    pub point: Option<f64>,
    /// Distance along the ray in extents, likewise.
    pub along: Option<f64>,
    /// Error of t in units in the last place, likewise and where these say anything.
    pub t_ulps: Option<f64>,
}

impl<'s> Judge<'s> {
    /// Of a scene; of boxes and solids it knows nothing, and takes every hit of one for a phantom.
    pub fn new(scene: &'s Scene, tolerance: Tolerance) -> Self {
        let mesh = match &scene.geometry {
            Geometry::Triangles(mesh) => MeshRef::from(mesh),
            Geometry::Boxes(_) | Geometry::Solids(_) => MeshRef { positions: &[], triangles: &[] },
        };
        let bounds = mesh.bounds();
        let extent = if bounds.is_empty() {
            0.0
        } else {
            (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max_element()
        };
        let oracle = Oracle::new((0..mesh.triangles.len()).map(|i| mesh.corners(i)));
        Self { mesh, oracle, extent, tolerance }
    }

    /// The oracle behind it.
    pub const fn oracle(&self) -> &Oracle {
        &self.oracle
    }

    /// The longest side of the scene's bounds.
    pub const fn extent(&self) -> f64 {
        self.extent
    }

    /// What a hit may be off.
    pub const fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// The exact answers to a set of rays; see [`Truth::of`].
    pub fn truth(&self, rays: &RaySet, heard: &mut dyn FnMut(usize)) -> Truth {
        Truth::of(&self.oracle, rays, heard)
    }

    /// Judges an answer by the exact one.
    ///
    /// A hit is in its place if it is within the tolerance of the true one along the ray, or as near as any `f32`. It is on the same
    /// surface if the true point is within the tolerance of the reported object, whichever object that is.
    pub fn judge(&self, ray: &Ray, reported: Option<Hit>, truth: Option<&TrueHit>) -> Judgement {
        let (hit, truth) = match (reported, truth) {
            (None, None) => return Judgement::default(),
            (None, Some(_)) => return Judgement { kind: Some(Kind::Hole), ..Judgement::default() },
            (Some(_), None) => return Judgement { kind: Some(Kind::Phantom), ..Judgement::default() },
            (Some(hit), Some(truth)) => (hit, truth),
        };
        let length = ray.direction.as_dvec3().length();
        let limit = self.tolerance.fraction() * self.extent;
        let off = (f64::from(hit.t) - truth.t).abs() * length;
        let same = hit.object == truth.object;
        let in_place = off <= limit || hit.t == truth.rounded;
        let place = point(self.corners(truth.object).unwrap_or_default(), truth.u, truth.v);
        let reported = self.corners(hit.object);
        let on_surface = same || reported.is_some_and(|corners| distance(place, &corners) <= limit);
        let kind = match (in_place, same) {
            (true, true) => None,
            (true, false) if self.is_tie(ray, &hit, truth) => Some(Kind::Tie),
            (true, false) => Some(Kind::Swapped),
            (false, _) if on_surface => Some(Kind::Displaced),
            (false, _) if f64::from(hit.t) > truth.t => Some(Kind::Hole),
            (false, _) => Some(Kind::Phantom),
        };
        if matches!(kind, Some(Kind::Hole | Kind::Phantom)) {
            return Judgement { kind, ..Judgement::default() };
        }
        let unit = if self.extent > 0.0 { self.extent } else { 1.0 };
        let found = reported.map(|corners| point(corners, hit.u.into(), hit.v.into()));
        let ordinary = truth.rounded.is_normal() && truth.t.abs() * length > limit;
        Judgement {
            kind,
            point: found.map(|found| between(found, place) / unit),
            along: Some(off / unit),
            t_ulps: ordinary.then(|| (f64::from(hit.t) - truth.t).abs() / ulp(truth.rounded)),
        }
    }

    /// Judges the answers to a set of rays, on all threads of the current pool.
    ///
    /// # Panics
    /// If there are fewer answers than rays.
    pub fn judge_all(&self, rays: &RaySet, truth: &Truth, hits: &[Option<Hit>]) -> Tally {
        let judge = |i: usize| self.judge(&rays.ray(i), hits[i], truth.0[i].as_ref());
        let judged: Vec<Judgement> =
            (0..truth.0.len()).into_par_iter().with_min_len(1 << 10).map(judge).collect();
        let mut tally = Tally::default();
        judged.iter().for_each(|judgement| tally.add(judgement));
        tally
    }

    /// Whether the ray hits the reported object too, at exactly the t of the true one.
    fn is_tie(&self, ray: &Ray, hit: &Hit, truth: &TrueHit) -> bool {
        let exact = |object: u32| intersect(ray, &self.corners(object)?).map(|hit| hit.t);
        exact(hit.object).is_some_and(|t| Some(t) == exact(truth.object))
    }

    fn corners(&self, object: u32) -> Option<Corners> {
        let object = object as usize;
        (object < self.mesh.triangles.len()).then(|| self.mesh.corners(object))
    }
}

/// The spacing of `f32` at a normal number.
fn ulp(value: f32) -> f64 {
    let value = value.abs();
    f64::from(value.next_up()) - f64::from(value)
}

/// Answers added up, with every error in space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// By kind.
    pub counts: Counts,
    points: Vec<f64>,
    along: Vec<f64>,
    t_ulps: Vec<f64>,
}

impl Tally {
    /// One more answer.
    pub fn add(&mut self, judgement: &Judgement) {
        self.counts.add(judgement.kind);
        self.points.extend(judgement.point);
        self.along.extend(judgement.along);
        self.t_ulps.extend(judgement.t_ulps);
    }

    /// The answers to more rays.
    pub fn extend(&mut self, other: Self) {
        self.counts += other.counts;
        self.points.extend(other.points);
        self.along.extend(other.along);
        self.t_ulps.extend(other.t_ulps);
    }

    /// The errors in space, summed up.
    pub fn errors(&mut self) -> Errors {
        Errors {
            hits: self.along.len() as u64,
            point: Spread::of(&mut self.points),
            along: Spread::of(&mut self.along),
            t_ulps: Spread::of(&mut self.t_ulps),
        }
    }
}
