//! Rays at what is there, at its corners and edges too, and past it.

use super::{Reach, lattice, point};
use crate::Numbers;
use accel::input::check_ray;
use accel::{Aabb, Geometry, Ray, Scene, Vec3};

/// So many rays for the scene, all of which structures accept.
pub fn rays(numbers: &mut impl Numbers, scene: &Scene, reach: &Reach, count: usize) -> Vec<Ray> {
    let bounds = scene.geometry.bounds();
    let (center, size) = (bounds.center(), bounds.extent().max_element());
    let mut all = Vec::with_capacity(count);
    // Numbers that only make unusable rays have an end.
    for _ in 0..2 * count {
        if all.len() == count {
            break;
        }
        let ray = match aim(numbers, scene) {
            None => Ray::new(point(numbers), point(numbers)),
            Some(target) => {
                let ray = toward(numbers, target, center, size, reach);
                ranged(numbers, ray)
            }
        };
        if check_ray(&bounds, &ray).is_ok() {
            all.push(ray);
        }
    }
    all
}

/// A point of an object, if there is one.
pub(super) fn aim(numbers: &mut impl Numbers, scene: &Scene) -> Option<Vec3> {
    let objects = scene.geometry.len() as u32;
    if objects == 0 {
        return None;
    }
    let object = numbers.below(objects) as usize;
    Some(match &scene.geometry {
        Geometry::Triangles(mesh) => target(numbers, mesh.corners(object)),
        Geometry::Boxes(boxes) => within(numbers, boxes[object]),
        Geometry::Solids(solids) => within(numbers, solids[object].bounds()),
    })
}

/// A point of a box: on its sides, edges and corners too.
fn within(numbers: &mut impl Numbers, Aabb { min, max }: Aabb) -> Vec3 {
    let mut at = |axis: usize| match numbers.below(4) {
        0 => min[axis],
        1 => max[axis],
        _ => min[axis] + (max[axis] - min[axis]) * numbers.unit().abs(),
    };
    Vec3::new(at(0), at(1), at(2))
}

/// A point of a triangle: a corner, on an edge, inside, or nearby.
fn target(numbers: &mut impl Numbers, [a, b, c]: [Vec3; 3]) -> Vec3 {
    match numbers.below(4) {
        0 => a,
        1 => a + (b - a) * numbers.unit().abs(),
        2 => (a + b + c) / 3.0,
        _ => a + (b - a) * numbers.unit() + (c - a) * numbers.unit(),
    }
}

/// Twos in the distance, in sizes of a scene, from which on rounded directions miss it.
const FAR_OUT: i32 = 22;

fn toward(numbers: &mut impl Numbers, target: Vec3, center: Vec3, size: f32, reach: &Reach) -> Ray {
    let away = size * 2f32.powi(reach.origins);
    // From far away only few directions lead anywhere near.
    let ways = if reach.origins > FAR_OUT { 3 } else { 6 };
    match numbers.below(ways) {
        // Along an axis, through the target on the others.
        0 => {
            let axis = numbers.below(3) as usize;
            let mut direction = Vec3::ZERO;
            direction[axis] = if numbers.below(2) == 0 { 1.0 } else { -1.0 };
            let mut origin = target;
            origin[axis] -= direction[axis] * away;
            Ray::new(origin, direction)
        }
        // Through the target without rounding, as far as the direction's few bits reach.
        1 => {
            let direction = lattice(numbers) * size;
            Ray::new(target - direction * 2f32.powi(reach.origins), direction)
        }
        // From inside.
        2 => {
            let origin = center + point(numbers) * size * 0.5;
            Ray::new(origin, target - origin)
        }
        // Anywhere.
        3 => Ray::new(center + point(numbers) * away, point(numbers)),
        _ => {
            let origin = center + point(numbers) * away;
            Ray::new(origin, target - origin)
        }
    }
}

/// The ray with another range now and then.
fn ranged(numbers: &mut impl Numbers, ray: Ray) -> Ray {
    match numbers.below(8) {
        0 => Ray { t_max: 1.0, ..ray },
        1 => Ray { t_min: 1.0, ..ray },
        2 => Ray { t_min: -1e30, ..ray },
        3 => Ray { t_min: numbers.unit() * 2.0, t_max: numbers.unit() * 2.0, ..ray },
        _ => ray,
    }
}
