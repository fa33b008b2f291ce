//! Machine parts: plates with bosses and bores, as sets of boxes and cylinders.

use crate::random::Random;
use accel::solid::{Combination, Cone, Csg};
use accel::{Aabb, Solid, Vec3};

/// Bores of a plate, along both sides.
const BORES: u32 = 4;

/// `count` plates in a square arrangement, each with a boss in its middle and a hole through it, [`BORES`]² countersunk bores, and
/// rounded ends; plates differ in thickness and in how wide their bores are.
pub fn machine_part(count: u32, seed: u64) -> Vec<Solid> {
    let mut random = Random::new(seed);
    let across = f64::from(count).sqrt().ceil() as u32;
    (0..count).map(|i| plate(&mut random, [2.4 * (i % across) as f32, 2.4 * (i / across) as f32])).collect()
}

fn plate(random: &mut Random, [x, y]: [f32; 2]) -> Solid {
    let at = |dx: f32, dy: f32, z: f32| Vec3::new(x + dx, y + dy, z);
    let cone = |dx: f32, dy: f32, [low, high]: [f32; 2], [r, s]: [f32; 2]| {
        Solid::Cone(Cone { base: at(dx, dy, low), base_radius: r, top: at(dx, dy, high), top_radius: s })
    };
    let thick = random.range(0.15, 0.3) as f32;
    let width = random.range(0.5, 0.8) as f32;
    let block =
        |half: f32, depth: f32| Solid::Box(Aabb { min: at(-half, -depth, 0.0), max: at(half, depth, thick) });
    let body = vec![
        block(1.0, 0.8),
        block(0.8, 1.0),
        cone(-0.8, -0.8, [0.0, thick], [0.2; 2]),
        cone(-0.8, 0.8, [0.0, thick], [0.2; 2]),
        cone(0.8, -0.8, [0.0, thick], [0.2; 2]),
        cone(0.8, 0.8, [0.0, thick], [0.2; 2]),
        cone(0.0, 0.0, [0.0, 2.0 * thick], [0.4; 2]),
    ];
    let mut bores = vec![cone(0.0, 0.0, [-0.1, 2.0 * thick + 0.1], [0.25; 2])];
    let place = |i: u32| 1.6 * (i as f32 + 0.5) / BORES as f32 - 0.8;
    for i in 0..BORES * BORES {
        let (dx, dy) = (place(i % BORES), place(i / BORES));
        if dx.hypot(dy) < 0.55 {
            continue;
        }
        let radius = 0.1 * width;
        bores.push(cone(dx, dy, [-0.1, thick + 0.1], [radius; 2]));
        bores.push(cone(dx, dy, [thick - radius, thick + 0.01], [radius, 2.0 * radius]));
    }
    let body = Csg::of(Combination::Union, body).expect("a body has parts");
    let bores = Csg::of(Combination::Union, bores).expect("a plate has bores");
    Solid::Csg(Csg::new(Combination::Difference, body, bores))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_closed_and_apart() {
        let parts = machine_part(5, 1);
        assert_eq!(parts.len(), 5);
        for (i, part) in parts.iter().enumerate() {
            part.validate().unwrap();
            let bounds = part.bounds();
            for other in &parts[..i] {
                let other = other.bounds();
                assert!(
                    bounds.min.x > other.max.x || bounds.max.x < other.min.x || bounds.min.y > other.max.y
                );
            }
        }
    }
}
