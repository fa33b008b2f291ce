//! What a model shows otherwise than the true surface.

use accel::{Hit, RaySet, Solid};
use glam::DVec3;
use judge::Spread;
use serde::{Deserialize, Serialize};

/// An image of a model held against the image of the true surface, ray by ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Pixels.
    pub pixels: u64,
    /// Those that show the true surface.
    pub shown: u64,
    /// Those of them where the model shows nothing: holes, at the silhouette mostly.
    pub holes: u64,
    /// Pixels where the model shows something and there is nothing.
    pub extra: u64,
    /// Where it shows another object.
    pub other: u64,
    /// Where it shows the right object, farther from its true surface than is allowed.
    pub displaced: u64,
    /// Distances from the true surface, across it, in the scene's units.
    pub distance: Spread,
    /// The same in widths of a pixel there.
    pub pixels_off: Spread,
    /// Angles between the facets' normals and the true ones, in degrees.
    pub degrees: Spread,
}

impl Errors {
    /// Pixels that are wrong in any of the ways.
    pub fn wrong(&self) -> u64 {
        self.holes + self.extra + self.other + self.displaced
    }

    /// Their part of those that show anything.
    pub fn wrong_part(&self) -> f64 {
        self.wrong() as f64 / (self.shown + self.extra).max(1) as f64
    }
}

/// What a model's image is held against.
pub struct Truth<'a> {
    /// The true objects.
    pub solids: &'a [Solid],
    /// The rays of the image.
    pub rays: &'a RaySet,
    /// What they hit.
    pub hits: &'a [Option<Hit>],
}

/// The solid that a hit stands for, and the normal there.
pub type Seen = (u32, Option<DVec3>);

/// What a model shows.
pub struct Shown<'a> {
    /// Its hits.
    pub hits: &'a [Option<Hit>],
    /// The solid and the normal of a hit.
    pub of: &'a dyn Fn(&Hit, DVec3) -> Seen,
}

/// How wide a pixel is at t: as far as neighbouring rays are apart there.
fn pixel_width(rays: &RaySet) -> impl Fn(f64) -> f64 {
    let ends = [0, 1].map(|i| rays.ray(i.min(rays.len() - 1)));
    let aside = (ends[1].origin - ends[0].origin).as_dvec3();
    let spread = (ends[1].direction - ends[0].direction).as_dvec3();
    move |t| (aside + spread * t).length()
}

/// Holds an image against the true one; what is farther than `allowed` widths of a pixel from the true surface is displaced.
pub fn errors(truth: &Truth<'_>, shown: &Shown<'_>, allowed: f64) -> Errors {
    let mut found = Errors { pixels: truth.hits.len() as u64, ..Errors::default() };
    let width = pixel_width(truth.rays);
    let (mut distances, mut widths, mut degrees) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (right, seen)) in truth.hits.iter().zip(shown.hits).enumerate() {
        found.shown += u64::from(right.is_some());
        let (right, seen) = match (right, seen) {
            (Some(right), Some(seen)) => (right, seen),
            (Some(_), None) => {
                found.holes += 1;
                continue;
            }
            (None, seen) => {
                found.extra += u64::from(seen.is_some());
                continue;
            }
        };
        let ray = truth.rays.ray(i);
        let at = |t: f32| ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(t);
        let (owner, normal) = (shown.of)(seen, at(seen.t));
        if owner != right.object {
            found.other += 1;
            continue;
        }
        let surface = normal_of(&truth.solids[right.object as usize], right, at(right.t));
        let apart = at(seen.t) - at(right.t);
        let across = surface.map_or(apart.length(), |normal| apart.dot(normal).abs());
        let off = across / width(f64::from(right.t)).max(f64::MIN_POSITIVE);
        found.displaced += u64::from(off > allowed);
        distances.push(across);
        widths.push(off);
        if let (Some(a), Some(b)) = (surface, normal) {
            // Surfaces are seen from both sides.
            degrees.push(libm::acos(a.dot(b).abs().min(1.0)).to_degrees());
        }
    }
    (found.distance, found.pixels_off) = (Spread::of(&mut distances), Spread::of(&mut widths));
    found.degrees = Spread::of(&mut degrees);
    found
}

/// The true normal at a hit.
pub fn normal_of(solid: &Solid, hit: &Hit, at: DVec3) -> Option<DVec3> {
    match solid {
        Solid::Patch(patch) => patch.normal_at(f64::from(hit.u), f64::from(hit.v)),
        other => other.normal(at),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::solid::Sphere;
    use accel::{Ray, Vec3};

    /// Each fault is planted in a pixel of its own.
    #[test]
    fn every_kind_of_error_is_found() {
        let ball = |x: f32| Solid::Sphere(Sphere { center: Vec3::new(x, 0.0, 0.0), radius: 1.0 });
        let solids = [ball(0.0), ball(10.0)];
        let rays: Vec<Ray> =
            (0..6).map(|i| Ray::new(Vec3::new(i as f32 * 0.01, 0.0, 5.0), Vec3::NEG_Z)).collect();
        let hit = |t: f32, object: u32| Some(Hit { t, object, u: 0.0, v: 0.0 });
        let right = [hit(4.0, 0), hit(4.0, 0), hit(4.0, 0), None, hit(4.0, 0), hit(4.0, 0)];
        let seen = [hit(4.0, 0), None, hit(4.0, 1), hit(4.0, 0), hit(4.001, 0), hit(4.1, 0)];
        let rays = RaySet::List(rays);
        let truth = Truth { solids: &solids, rays: &rays, hits: &right };
        let of = |hit: &Hit, _: DVec3| (hit.object, Some(DVec3::new(0.0, 0.6, 0.8)));
        let found = errors(&truth, &Shown { hits: &seen, of: &of }, 0.5);
        assert_eq!((found.pixels, found.shown), (6, 5));
        assert_eq!((found.holes, found.extra, found.other, found.displaced), (1, 1, 1, 1));
        assert_eq!(found.wrong(), 4);
        assert!((found.distance.largest - 0.1).abs() < 1e-3 && (found.pixels_off.largest - 10.0).abs() < 0.1);
        assert!(found.degrees.median > 30.0 && found.degrees.largest < 45.0);
    }
}
