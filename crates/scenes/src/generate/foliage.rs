//! A tree in leaf: objects of many sizes that make no surface, their boxes overlapping everywhere.

use crate::random::Random;
use crate::solid::{Solid, round, tessellate};
use accel::Mesh;
use glam::DVec3;
use std::f64::consts::TAU;

/// Triangles of a branch: the mantle of a cone with six sides.
const BRANCH: u32 = 12;
/// The wood has at most this part of the triangles, unless the tree is a single branch.
const WOOD: u32 = 4;
/// A branch's length over its width at the base.
const SLENDER: f64 = 14.0;
/// The fewest triangles: a trunk with one leaf.
pub const MIN: u32 = BRANCH + 2;

struct Twig {
    base: DVec3,
    tip: DVec3,
}

/// A tree of `count` triangles, one fewer where `count` is odd: a trunk of length 1 that forks into
/// two again and again, its branches mantles of six-sided cones, and leaves of two triangles each
/// about its outermost twigs, in any attitude.
///
/// The tree forks as often as leaves three quarters of the triangles to the leaves.
pub fn foliage(count: u32, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let mut forks = 0;
    while BRANCH * ((4 << forks) - 1) <= count / WOOD {
        forks += 1;
    }
    let (mut wood, mut twigs) = (Vec::new(), Vec::new());
    grow(&mut wood, &mut twigs, &mut random, DVec3::ZERO, DVec3::Z, 1.0, forks);
    let mut mesh = tessellate(&wood, BRANCH / 2);
    let leaves = (count as usize).saturating_sub(mesh.triangles.len()) / 2;
    for i in 0..leaves {
        leaf(&mut mesh, &mut random, &twigs[i * twigs.len() / leaves]);
    }
    mesh
}

fn grow(
    wood: &mut Vec<Solid>,
    twigs: &mut Vec<Twig>,
    random: &mut Random,
    base: DVec3,
    direction: DVec3,
    length: f64,
    forks: u32,
) {
    let (tip, base_radius) = (base + direction * length, length / (2.0 * SLENDER));
    wood.push(Solid::Cone { base, base_radius, apex: tip, apex_radius: 0.6 * base_radius });
    if forks == 0 {
        twigs.push(Twig { base, tip });
        return;
    }
    let (x, y) = direction.any_orthonormal_pair();
    let azimuth = random.range(0.0, TAU);
    for side in [1.0, -1.0] {
        let (sin, cos) = libm::sincos(azimuth + random.range(-0.5, 0.5));
        let tilt = random.range(0.25, 0.85);
        let (sin_tilt, cos_tilt) = libm::sincos(tilt);
        let child = direction * cos_tilt + (x * cos + y * sin) * (side * sin_tilt);
        let length = length * random.range(0.68, 0.88);
        grow(wood, twigs, random, tip, child.normalize(), length, forks - 1);
    }
}

/// Two triangles that share the leaf's rib, folded along it.
fn leaf(mesh: &mut Mesh, random: &mut Random, twig: &Twig) {
    let along = twig.tip - twig.base;
    let stem = twig.base + along * random.range(0.1, 1.1);
    let length = along.length() * random.range(0.15, 0.6);
    let rib = random.direction();
    let (across, normal) = rib.any_orthonormal_pair();
    let (sin, cos) = libm::sincos(random.range(0.0, TAU));
    let (across, normal) = (across * cos + normal * sin, normal * cos - across * sin);
    let widest = stem + rib * (0.45 * length) + normal * (0.06 * length);
    let half = across * (0.25 * length);
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([stem, stem + rib * length, widest + half, widest - half].map(round));
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 3, first + 1]]);
}

#[cfg(test)]
mod tests {
    use super::super::tests::assert_counts;
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn the_count_is_the_one_asked_for() {
        let counts = [(14, 14), (15, 14), (100, 100), (9_999, 9_998), (100_000, 100_000)];
        assert_counts(foliage, &counts);
    }

    #[test]
    fn most_triangles_are_leaves_that_share_nothing_with_the_next() {
        let mesh = foliage(100_000, 1);
        // A leaf is the one piece that has four corners of its own in two triangles.
        let leaves = mesh.triangles.chunks(2).rev().take_while(|pair| {
            let corners: HashSet<u32> = pair.iter().flatten().copied().collect();
            corners.len() == 4 && corners.iter().max().unwrap() - corners.iter().min().unwrap() == 3
        });
        let leaves = leaves.count();
        assert!((37_500..=50_000).contains(&leaves), "{leaves}");
    }

    #[test]
    fn sizes_differ_by_orders_of_magnitude() {
        let mesh = foliage(100_000, 1);
        let longest = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            a.distance(b).max(b.distance(c)).max(c.distance(a))
        };
        let mut edges: Vec<f32> = mesh.triangles.iter().map(longest).collect();
        edges.sort_by(f32::total_cmp);
        assert!(edges[edges.len() - 1] > 100.0 * edges[edges.len() / 100], "{}", edges[edges.len() / 100]);
    }
}
