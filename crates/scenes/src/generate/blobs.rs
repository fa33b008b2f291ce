//! Blobs: implicit surfaces about a few points each.

use crate::random::Random;
use accel::solid::{Expression, Implicit};
use accel::{Aabb, Solid, Vec3};
use glam::DVec3;
use std::fmt::Write;
use std::sync::Arc;

/// The level of the sum of Gaussian bells whose inside is the blob (J. Blinn 1982, "A Generalization of Algebraic Surface
/// Drawing", ACM Transactions on Graphics 1(3)).
const LEVEL: f64 = 0.6;

/// How fast bells fall with the square of the distance, in the blob's radius.
const FALL: f64 = 6.0;

/// `count` blobs of three to five bells, scattered in the unit cube.
pub fn blobs(count: u32, seed: u64) -> Vec<Solid> {
    let mut random = Random::new(seed);
    let radius = 0.3 / f64::from(count.max(1)).cbrt();
    (0..count).map(|_| blob(&mut random, radius)).collect()
}

fn blob(random: &mut Random, radius: f64) -> Solid {
    let center = random.in_cube(0.0, 1.0);
    let bells: Vec<DVec3> =
        (0..3 + random.below(3)).map(|_| center + random.direction() * (radius * random.unit())).collect();
    let mut text = format!("{LEVEL}");
    let steep = FALL / (radius * radius);
    for bell in &bells {
        let [x, y, z] = bell.to_array();
        // Shortest form that reads back the same, so that the text is the blob.
        let written = write!(text, " - exp(-{steep}*((x - {x})^2 + (y - {y})^2 + (z - {z})^2))");
        written.expect("texts take what is written");
    }
    // Beyond this distance from all of them, all bells together are below the level.
    let reach = radius * (libm::log(bells.len() as f64 / LEVEL) / FALL).sqrt() * 1.0001;
    let bounds = bells.iter().fold(Aabb::EMPTY, |all, bell| {
        let [low, high] = [*bell - reach, *bell + reach].map(|p| p.as_vec3());
        all.union(Aabb { min: low - Vec3::splat(f32::EPSILON), max: high + Vec3::splat(f32::EPSILON) })
    });
    let function = Expression::parse(&text).expect("the text of a blob is an expression");
    Solid::Implicit(Implicit::new(Arc::new(function), bounds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blobs_end_within_their_boxes() {
        for solid in blobs(40, 7) {
            let Solid::Implicit(blob) = &solid else { panic!("a blob") };
            solid.validate().unwrap();
            let (min, max) = (blob.bounds.min.as_dvec3(), blob.bounds.max.as_dvec3());
            let value = |p: DVec3| blob.gradient(p).value;
            assert!(value((min + max) * 0.5) < LEVEL);
            for i in 0..=20 {
                for j in 0..=20 {
                    let place = DVec3::new(f64::from(i), f64::from(j), 0.0) / 20.0;
                    for axis in 0..3 {
                        for side in [0.0, 1.0] {
                            let mut at = [place.x, place.y];
                            let mut p = DVec3::ZERO;
                            for (k, place) in p.as_mut().iter_mut().enumerate() {
                                *place = if k == axis { side } else { at[usize::from(k == (axis + 1) % 3)] };
                            }
                            at.reverse();
                            assert!(value(min + (max - min) * p) > 0.0);
                        }
                    }
                }
            }
        }
    }
}
