//! Sets for checking: rays where structures and kernels are known to fail.

use super::features::{any_face, corner, face, normal, point_in, point_on_edge};
use super::frame::Frame;
use super::id::{RaysError, RaysId};
use super::lines;
use super::spawn::starts;
use super::spec::RaysSpec;
use crate::random::Random;
use accel::{Accel, Geometry, Hit, Ray, RaySet, Scene, Vec3};
use glam::DVec3;

/// The rays of any set for checking.
pub fn rays(scene: &Scene, spec: &RaysSpec, tracer: &dyn Accel) -> Result<Vec<Ray>, RaysError> {
    let of_objects = !matches!(spec.id, RaysId::Bounds | RaysId::Directions);
    if of_objects && scene.geometry.is_empty() {
        return Err(RaysError::NoObjects { rays: spec.id, scene: scene.id.clone() });
    }
    match spec.id {
        RaysId::Surface => surface(scene, spec, tracer),
        RaysId::Range => range(scene, spec, tracer),
        _ => Ok(aimed(scene, spec)),
    }
}

fn aimed(scene: &Scene, spec: &RaysSpec) -> Vec<Ray> {
    let frame = Frame::of(scene);
    let geometry = &scene.geometry;
    let mut random = Random::new(spec.seed ^ 3);
    let mut ray = || match spec.id {
        RaysId::Bounds => bounds(&frame, &mut random),
        RaysId::Directions => directions(&frame, &mut random),
        RaysId::Inside => inside(geometry, &mut random),
        RaysId::Plane => plane(geometry, &mut random),
        id => {
            let face = any_face(geometry, &mut random);
            let target = match id {
                RaysId::LeakFace => point_in(&face, &mut random),
                RaysId::Edge | RaysId::LeakEdge => point_on_edge(&face, &mut random),
                _ => corner(&face, &mut random),
            };
            let origin = match id {
                RaysId::LeakFace | RaysId::LeakEdge | RaysId::LeakVertex => {
                    frame.center() + random.in_cube(-0.125, 0.125) * (frame.max - frame.min)
                }
                _ if random.below(2) == 0 => frame.point(&mut random),
                _ => frame.around_point(&mut random, 2.0),
            };
            towards(origin.as_vec3(), target)
        }
    };
    // A direction may round to zero (an origin on its target): such rays are drawn again. Scenes of one point
    // give nothing else, so there is an end to it.
    let attempts = 4 * spec.count();
    (0..attempts).map(|_| ray()).filter(|ray| ray.validate().is_ok()).take(spec.count()).collect()
}

/// The direction is rounded once: its error is in the last place of the largest coordinate.
fn towards(origin: Vec3, target: Vec3) -> Ray {
    Ray::new(origin, target - origin)
}

fn bounds(frame: &Frame, random: &mut Random) -> Ray {
    let mut origin = frame.point(random);
    for a in 0..3 {
        origin[a] = match random.below(6) {
            0 | 1 => frame.min[a],
            2 | 3 => frame.max[a],
            4 => origin[a] + frame.radius * random.range(-3.0, 3.0),
            _ => origin[a],
        };
    }
    let direction = match random.below(3) {
        0 => random.direction(),
        1 => (frame.point(random) - origin).normalize_or(DVec3::X),
        // Along the bounds' faces and edges.
        _ => DVec3::from_array([(); 3].map(|()| random.below(3) as f64 - 1.0)),
    };
    Ray::new(origin.as_vec3(), direction.as_vec3())
}

fn directions(frame: &Frame, random: &mut Random) -> Ray {
    const ODD: [f32; 10] = [0.0, -0.0, 1e-40, -1e-40, 1e-30, -1e-30, 1.2e-7, 1e-5, 1e18, -1e18];
    let target = frame.point(random);
    let mut direction = random.direction().as_vec3();
    let first = random.below(3);
    for a in [first, (first + 1) % 3].into_iter().take(1 + random.below(2)) {
        direction[a] = ODD[random.below(ODD.len())];
    }
    if random.below(4) == 0 {
        // The same direction in another unit of t.
        direction *= [1e-20, 1e-6, 1e6, 1e20][random.below(4)];
    }
    let unit = direction.as_dvec3().normalize_or(DVec3::X);
    Ray::new((target - unit * (frame.radius * random.range(0.0, 2.0))).as_vec3(), direction)
}

fn inside(geometry: &Geometry, random: &mut Random) -> Ray {
    let object = random.below(geometry.len());
    let face = face(geometry, random, object);
    let origin = match (geometry, random.below(3)) {
        (Geometry::Boxes(boxes), 0 | 1) => {
            let b = boxes[object];
            b.min + (b.max - b.min) * random.in_cube(0.0, 1.0).as_vec3()
        }
        (Geometry::Solids(solids), 0) => {
            let b = solids[object].bounds();
            b.min + (b.max - b.min) * random.in_cube(0.0, 1.0).as_vec3()
        }
        (_, 0) => {
            let (low, high) = face.iter().fold((face[0], face[0]), |(l, h), p| (l.min(*p), h.max(*p)));
            low + (high - low) * random.in_cube(0.0, 1.0).as_vec3()
        }
        (_, 1) => corner(&face, random),
        _ => point_in(&face, random),
    };
    Ray::new(origin, random.direction().as_vec3())
}

fn plane(geometry: &Geometry, random: &mut Random) -> Ray {
    let face = any_face(geometry, random);
    let k = random.below(face.len());
    let (a, b) = (face[k], face[(k + 1) % face.len()]);
    match random.below(3) {
        // Along an edge, from before it.
        0 => Ray::new(a - (b - a), b - a),
        // Through a corner and the opposite edge.
        1 => {
            let c = face[(k + 2) % face.len()];
            let across = (a + (b - a) * 0.5) - c;
            Ray::new(c - across, across)
        }
        // Any direction of the plane.
        _ => {
            let n = normal(&face).unwrap_or(DVec3::Z);
            let along = n.cross(random.direction()).normalize_or(n.any_orthonormal_vector());
            let size = f64::from((b - a).abs().max_element());
            let origin = point_in(&face, random).as_dvec3() - along * (2.0 * size);
            Ray::new(origin.as_vec3(), along.as_vec3())
        }
    }
}

fn no_hits(scene: &Scene, spec: &RaysSpec) -> RaysError {
    RaysError::NoHits { rays: spec.id, scene: scene.id.clone() }
}

/// Rays that begin at hit points as computed, on either side of the surface or in it.
fn surface(scene: &Scene, spec: &RaysSpec, tracer: &dyn Accel) -> Result<Vec<Ray>, RaysError> {
    let starts = starts(scene, &RaySet::List(lines::random(scene, spec)), tracer);
    if starts.is_empty() {
        return Err(no_hits(scene, spec));
    }
    let mut random = Random::new(spec.seed ^ 4);
    let ray = |i: usize| {
        let start = &starts[i * starts.len() / spec.count()];
        let direction = match random.below(4) {
            0 => start.normal,
            1 => -start.normal,
            _ => random.direction(),
        };
        Ray::new(start.point.as_vec3(), direction.as_vec3())
    };
    Ok((0..spec.count()).map(ray).collect())
}

/// Random rays with a range that begins or ends at their hit, or one float beside it.
fn range(scene: &Scene, spec: &RaysSpec, tracer: &dyn Accel) -> Result<Vec<Ray>, RaysError> {
    let mut rays = lines::random(scene, spec);
    let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
    tracer.trace(&RaySet::List(rays.clone()), &mut hits);
    if hits.iter().all(Option::is_none) {
        return Err(no_hits(scene, spec));
    }
    for (i, (ray, hit)) in rays.iter_mut().zip(&hits).enumerate() {
        if let Some(t) = hit.map(|hit| hit.t) {
            (ray.t_min, ray.t_max) = match i % 5 {
                0 => (0.0, t),
                1 => (t, f32::INFINITY),
                2 => (t, t),
                3 => (t.next_up(), f32::INFINITY),
                _ => (0.0, t.next_down()),
            };
        }
    }
    Ok(rays)
}
