//! Lists of rays that need no hits: random ones, and ones parallel to an axis.

use super::features::{any_face, corner};
use super::frame::Frame;
use super::spec::RaysSpec;
use crate::random::Random;
use accel::{Ray, Scene, Vec3};
use glam::DVec3;

/// Rays from the sphere of 1.5 times the bounds' radius through points uniform in the bounds.
pub fn random(scene: &Scene, spec: &RaysSpec) -> Vec<Ray> {
    let frame = Frame::of(scene);
    let mut random = Random::new(spec.seed);
    (0..spec.count())
        .map(|_| {
            let origin = frame.around_point(&mut random, 1.5);
            let direction = (frame.point(&mut random) - origin).normalize();
            Ray::new(origin.as_vec3(), direction.as_vec3())
        })
        .collect()
}

/// Rays parallel to an axis, from before the bounds or inside. Across it each coordinate is, a third of the
/// time each, in a plane that divides the bounds into a power of two of slices, at an object's corner, or
/// anywhere. Direction components across are 0 or −0.
pub fn axis(scene: &Scene, spec: &RaysSpec) -> Vec<Ray> {
    let frame = Frame::of(scene);
    let mut random = Random::new(spec.seed ^ 1);
    (0..spec.count())
        .map(|_| {
            let along = random.below(3);
            let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
            let anywhere = frame.point(&mut random);
            let at_corner = at_corner(scene, &mut random).unwrap_or(anywhere);
            let mut origin = DVec3::ZERO;
            for a in 0..3 {
                origin[a] = match random.below(3) {
                    0 => {
                        let slices = 1 << random.below(9);
                        frame.slice_plane(&mut random, a, slices)
                    }
                    1 => at_corner[a],
                    _ => anywhere[a],
                };
            }
            if random.below(4) > 0 {
                let side = if sign > 0.0 { frame.min[along] } else { frame.max[along] };
                origin[along] = side - sign * frame.radius * random.unit();
            }
            let mut direction =
                Vec3::from_array([(); 3].map(|()| if random.below(2) == 0 { 0.0 } else { -0.0 }));
            direction[along] = sign as f32;
            Ray::new(origin.as_vec3(), direction)
        })
        .collect()
}

fn at_corner(scene: &Scene, random: &mut Random) -> Option<DVec3> {
    let geometry = &scene.geometry;
    (!geometry.is_empty()).then(|| corner(&any_face(geometry, random), random).as_dvec3())
}
