//! A ball of hair: thin, dense, and coherent, as neighbours lie along one another.

use crate::random::Random;
use crate::solid::round;
use accel::Mesh;
use glam::DVec3;

/// Pieces of a strand, two triangles each.
const PIECES: u32 = 45;
/// Triangles of a strand.
pub const STRAND: u32 = 2 * PIECES;
/// A strand's width at its root; the ball that it grows from has radius 1.
const WIDTH: f64 = 0.005;
/// How far a strand turns from its direction into the hair's, a piece.
const COMBED: f64 = 0.09;

/// Ribbons of 45 pieces that grow from a ball of radius 1 into a common flow, tapering to their tips:
/// as many as come nearest to `count` triangles at 90 a ribbon, and at least one.
pub fn strands(count: u32, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let strands = (count + STRAND / 2) / STRAND;
    let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    for _ in 0..strands.max(1) {
        strand(&mut mesh, &mut random);
    }
    mesh
}

fn strand(mesh: &mut Mesh, random: &mut Random) {
    let mut direction = random.direction();
    let mut at = direction;
    let mut across = direction.any_orthonormal_vector();
    let curl = random.direction() * 0.03;
    let step = random.range(0.7, 1.3) / f64::from(PIECES);
    let first = mesh.positions.len() as u32;
    for i in 0..=PIECES {
        let taper = 1.0 - 0.85 * f64::from(i) / f64::from(PIECES);
        let half = across * (0.5 * WIDTH * taper);
        mesh.positions.extend([at - half, at + half].map(round));
        at += direction * step;
        direction = (direction + flow(at) * COMBED + curl).normalize();
        across = (across - direction * across.dot(direction)).normalize();
    }
    let piece = |i: u32| [[0, 1, 3], [0, 3, 2]].map(|t| t.map(|k| first + 2 * i + k));
    mesh.triangles.extend((0..PIECES).flat_map(piece));
}

/// Where the hair at `p` lies: around the ball, in waves, and down.
fn flow(p: DVec3) -> DVec3 {
    let waves = DVec3::new(
        libm::sin(3.0 * p.y + 2.0 * p.z),
        libm::sin(3.0 * p.z + 2.0 * p.x),
        libm::sin(3.0 * p.x + 2.0 * p.y),
    );
    DVec3::new(-p.y, p.x, -0.7) * 0.5 + waves * 0.6
}

#[cfg(test)]
mod tests {
    use super::super::tests::assert_counts;
    use super::*;

    #[test]
    fn the_count_is_a_whole_number_of_strands() {
        assert_counts(strands, &[(1, 90), (90, 90), (134, 90), (135, 180), (100_000, 99_990)]);
    }

    #[test]
    fn strands_are_long_thin_and_outside_the_ball() {
        let mesh = strands(9_000, 1);
        for strand in mesh.positions.chunks(2 * (PIECES as usize + 1)) {
            let middle: Vec<_> = strand.chunks(2).map(|pair| (pair[0] + pair[1]) * 0.5).collect();
            let length: f32 = middle.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let width = strand[0].distance(strand[1]);
            assert!(length > 100.0 * width, "{length} {width}");
            assert!((middle[0].length() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn neighbours_lie_along_one_another() {
        let mesh = strands(90_000, 1);
        // Strand ends whose roots are close.
        let ends: Vec<_> = mesh
            .positions
            .chunks(2 * (PIECES as usize + 1))
            .map(|s| (s[0], (s[2 * PIECES as usize] - s[0]).normalize()))
            .collect();
        let (mut sum, mut pairs) = (0.0, 0);
        for (i, a) in ends.iter().enumerate() {
            for b in ends[..i].iter().filter(|b| a.0.distance(b.0) < 0.1) {
                sum += a.1.dot(b.1);
                pairs += 1;
            }
        }
        assert!(pairs > 100 && sum / pairs as f32 > 0.8, "{pairs} {}", sum / pairs as f32);
    }
}
