//! Crossings against a far finer search that knows nothing but what is inside.

use accel::testing::{random, rays, solid};
use accel::{Objects, Ray, Solid, Vec3};
use glam::DVec3;
use solids::{Crossing, Crossings, Solids};

const CLOSED: [&str; 6] = ["box", "sphere", "cone", "cylinder", "quadric", "torus"];

/// How deep a point is inside, in about the unit of length; below 0 outside.
fn depth(solid: &Solid, p: DVec3) -> f64 {
    match solid {
        Solid::Box(b) => {
            let (low, high) = (p - b.min.as_dvec3(), b.max.as_dvec3() - p);
            low.min(high).min_element()
        }
        Solid::Sphere(s) => f64::from(s.radius) - p.distance(s.center.as_dvec3()),
        Solid::Cone(c) => {
            let (base, top) = (c.base.as_dvec3(), c.top.as_dvec3());
            let (height, axis) = ((top - base).length(), (top - base).normalize());
            let along = (p - base).dot(axis);
            let slope = (f64::from(c.top_radius) - f64::from(c.base_radius)) / height;
            let radius = f64::from(c.base_radius) + slope * along;
            along.min(height - along).min(radius - (p - base - axis * along).length())
        }
        Solid::Quadric(q) => {
            let from = p - q.center();
            let surface = -q.value(from) / (2.0 * q.half_gradient(from).length()).max(1e-9);
            surface.min(depth(&Solid::Box(q.bounds), p))
        }
        Solid::Torus(t) => {
            let (axis, from) = (t.axis.as_dvec3().normalize(), p - t.center.as_dvec3());
            let height = from.dot(axis);
            f64::from(t.minor) - ((from - axis * height).length() - f64::from(t.major)).hypot(height)
        }
        _ => unreachable!("they have no inside, or tests of their own"),
    }
}

fn at(ray: &Ray, t: f64) -> DVec3 {
    ray.origin.as_dvec3() + ray.direction.as_dvec3() * t
}

fn crossings(solid: &Solid, ray: &Ray) -> Vec<Crossing> {
    let mut out = Vec::new();
    solid.crossings(&Ray { t_min: -1e30, t_max: f32::INFINITY, ..*ray }, &mut out);
    out
}

#[test]
fn no_crossing_is_missed_and_none_invented() {
    const SAMPLES: usize = 1000;
    let mut found = 0;
    for kind in CLOSED {
        let mut random = random(17);
        for (i, ray) in rays(19, 1500).into_iter().enumerate() {
            let center = Vec3::new(random(), random(), random()) * 0.3;
            let solid = solid(kind, center, 0.5, &mut random);
            let crossings = crossings(&solid, &ray);
            assert!(crossings.windows(2).all(|w| w[0].t <= w[1].t && w[0].enters != w[1].enters));
            assert!(
                crossings.first().is_none_or(|c| c.enters) && crossings.len().is_multiple_of(2),
                "{kind} {i}"
            );
            let close = 1e-9 + 1e-14 * ray.origin.as_dvec3().length();
            for crossing in &crossings {
                let off = depth(&solid, at(&ray, crossing.t)).abs();
                assert!(off < close, "{kind} {i}: {crossing:?} is {off} beside {solid:?}");
            }
            let Some((near, far)) = solid.bounds().padded(0.1).overlap(ray.origin, ray.direction) else {
                assert!(crossings.is_empty());
                continue;
            };
            let sample = |k: usize| near + (far - near) * k as f64 / SAMPLES as f64;
            for k in 0..=SAMPLES {
                let inside = depth(&solid, at(&ray, sample(k)));
                let told = crossings.iter().filter(|c| c.t <= sample(k)).count() % 2 == 1;
                // At the wall itself either is right.
                assert!(
                    inside.abs() < close || told == (inside > 0.0),
                    "{kind} {i}: {solid:?} {ray:?} at {}",
                    sample(k)
                );
            }
            found += crossings.len();
        }
    }
    assert!(found > 2500, "{found}");
}

/// The nearest is the first crossing in range; and where it is computed in single precision, it lies on the surface to what single
/// precision can tell.
#[test]
fn the_nearest_is_the_first_or_beside_the_surface() {
    let mut hits = 0;
    for kind in CLOSED.into_iter().chain(["disc", "triangle"]) {
        let mut random = random(23);
        for ray in rays(29, 1500) {
            let solid = solid(kind, Vec3::new(random(), random(), random()), 0.3, &mut random);
            let mut out = Vec::new();
            solid.crossings(&ray, &mut out);
            assert_eq!(solid.nearest(&ray, ray.t_max), out.first().map(Crossing::surface), "{kind}");
            if matches!(kind, "disc" | "triangle") {
                continue;
            }
            let all = [solid, Solid::Box(accel::Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE })];
            if let Some(hit) = Solids::new(&all).intersect(0, &ray, ray.t_max) {
                let off = depth(&all[0], at(&ray, f64::from(hit.t))).abs();
                assert!(
                    off < 2e-5,
                    "{kind}: {off} beside {:?}, {hit:?} {:?} {ray:?}",
                    all[0],
                    crossings(&all[0], &ray)
                );
                hits += 1;
            }
        }
    }
    assert!(hits > 250, "{hits}");
}

/// Normals point away from the inside.
#[test]
fn normals_point_outward() {
    for kind in CLOSED {
        let mut random = random(31);
        for ray in rays(37, 300) {
            let solid = solid(kind, Vec3::ZERO, 0.7, &mut random);
            for crossing in crossings(&solid, &ray) {
                let p = at(&ray, crossing.t);
                let normal = solid.normal(p).unwrap();
                let step = normal * 1e-4;
                assert!(depth(&solid, p + step) < 0.0, "{kind}: {solid:?} at {p}, {normal}");
            }
        }
    }
}
