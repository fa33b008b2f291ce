//! Rays from hits never hit the same place again: `reintersection [SHAPES] [RAYS]`, by default 1000 shapes a kind and 4000 rays a hit.
//!
//! As in pbrt's test of shapes (M. Pharr, W. Jakob, G. Humphreys, *Physically Based Rendering*, §3.9): shapes of sizes from 10^-4 to 10^4,
//! one hit each by a ray from up to 10^4 sizes away; from there, moved outward by the bound of its error, rays in every direction on
//! the outer side.

use accel::testing::{KINDS, random, solid};
use accel::{Objects, Ray, Solid, Vec3};
use glam::DVec3;
use solids::Solids;
use std::process::ExitCode;

/// What came of a kind.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found {
    /// Rays sent from hits.
    pub rays: u64,
    /// Rays that hit their own shape.
    pub again: u64,
    /// Those of them that do so nearer than twice the bound.
    pub below: u64,
}

/// How far a hit's place may be off, on any axis: 2^-19 of the shape's extent, and 2^-22 of the way there and of the coordinates.
fn bound(extent: f64, way: f64, place: DVec3) -> f64 {
    extent / f64::from(1 << 19) + (way + place.abs().max_element()) / f64::from(1 << 22)
}

/// Whether a kind has no hollows, so that no ray from its surface outward meets it again.
pub fn is_convex(kind: &str) -> bool {
    !matches!(kind, "torus" | "quadric")
}

/// So many shapes of a kind, and so many rays from a hit on each.
pub fn run(kind: &str, exact: bool, shapes: u32, rays: u32) -> Found {
    let mut random = random(83);
    let mut found = Found::default();
    let mut done = 0;
    while done < shapes {
        let size = 10f32.powf(random() * 4.0);
        let center = Vec3::new(random(), random(), random()) * 3.0 * size;
        let all = [solid(kind, center, size, &mut random)];
        let objects = if exact { Solids::exact(&all) } else { Solids::new(&all) };
        let [shape] = &all;
        let mut point = || Vec3::new(random(), random(), random());
        let (aim, away) = (center + point() * size * 0.5, point());
        let origin = center + away.normalize_or(Vec3::X) * size * 10f32.powf(2.0 + 2.0 * point().x);
        let ray = Ray::new(origin, aim - origin);
        let Some(hit) = objects.intersect(0, &ray, ray.t_max) else { continue };
        let place = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
        let Some(normal) = outward(shape, place, &ray) else { continue };
        done += 1;
        let extent = f64::from(shape.bounds().extent().max_element());
        let bound = bound(extent, place.distance(ray.origin.as_dvec3()), place);
        // The longer way along an axis makes up for the normal's slant.
        let from = (place + normal * (bound * 3f64.sqrt())).as_vec3();
        for _ in 0..rays {
            let mut direction = point();
            if direction.as_dvec3().dot(normal) < 0.0 {
                direction = -direction;
            }
            if direction == Vec3::ZERO {
                continue;
            }
            let ray = Ray::new(from, direction);
            found.rays += 1;
            if let Some(hit) = objects.intersect(0, &ray, ray.t_max) {
                found.again += 1;
                found.below += u64::from(f64::from(hit.t) * direction.as_dvec3().length() < 2.0 * bound);
            }
        }
    }
    found
}

/// The normal on the side that the ray comes from.
fn outward(shape: &Solid, place: DVec3, ray: &Ray) -> Option<DVec3> {
    let normal = shape.normal(place)?;
    let facing = if normal.dot(ray.direction.as_dvec3()) > 0.0 { -normal } else { normal };
    // What is closed has one outer side, and a ray from outside enters there.
    Some(if matches!(shape, Solid::Triangle(_) | Solid::Disc(_)) { facing } else { normal })
}

#[allow(dead_code, reason = "the test that includes this file has a smaller run")]
fn main() -> ExitCode {
    let number = |at: usize, otherwise: u32| {
        std::env::args().nth(at).map_or(Some(otherwise), |text| text.parse().ok())
    };
    let (Some(shapes), Some(rays)) = (number(1, 1000), number(2, 4000)) else {
        eprintln!("usage: reintersection [SHAPES] [RAYS]");
        return ExitCode::from(2);
    };
    let mut sound = true;
    for (kind, exact) in KINDS.into_iter().map(|kind| (kind, false)).chain([("sphere", true)]) {
        let Found { rays, again, below } = run(kind, exact, shapes, rays);
        sound &= below == 0 && (again == 0 || !is_convex(kind));
        let test = if exact { ", exact" } else { "" };
        println!("{kind}{test}: {rays} rays, {again} hit the shape again, {below} of them below the bound");
    }
    ExitCode::from(u8::from(!sound))
}
