//! How many rays are best taken together.

use super::scratch::STREAM;
use accel::Ray;

/// From this many blocks on more rays are taken together: of few, too few would reach each block.
const MANY_BLOCKS: usize = 1 << 11;

/// Pairs of consecutive rays that are looked at.
const PAIRS: usize = 32;

/// Rays are neighbours if they begin within this part of the scene's longest side of each other.
const NEAR: f32 = 1.0 / 16.0;

/// How many of the next rays to take together, over so many blocks in a scene whose longest side is `extent`.
///
/// Neighbours come to the same blocks, so that short streams, which fit into a cache of the second level with what they visit, fill
/// lists as well; scattered rays need long ones.
pub(super) fn stream_len(blocks: usize, extent: f32, next: &[Ray]) -> usize {
    let most = if blocks < MANY_BLOCKS { STREAM / 4 } else { STREAM };
    if are_neighbours(extent, &next[..next.len().min(most)]) { most / 2 } else { most }
}

/// Whether most rays begin near the one before.
fn are_neighbours(extent: f32, rays: &[Ray]) -> bool {
    let step = (rays.len() / PAIRS).max(2);
    let (mut near, mut pairs) = (0, 0);
    for pair in rays.chunks(step) {
        let [a, b, ..] = pair else { break };
        near += usize::from((a.origin - b.origin).abs().max_element() < NEAR * extent);
        pairs += 1;
    }
    2 * near > pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;

    /// Rays along a line, so far from each other.
    fn row(step: f32) -> Vec<Ray> {
        let ray = |i: usize| Ray::new(Vec3::new(i as f32 * step, 0.0, 0.0), Vec3::X);
        (0..2 * STREAM).map(ray).collect()
    }

    #[test]
    fn neighbours_and_few_blocks_make_streams_short() {
        for (blocks, step, wanted) in [
            (10, 0.01, STREAM / 8),
            (10, 0.2, STREAM / 4),
            (MANY_BLOCKS, 0.01, STREAM / 2),
            (MANY_BLOCKS, 0.2, STREAM),
        ] {
            assert_eq!(stream_len(blocks, 1.0, &row(step)), wanted, "{blocks} {step}");
        }
        assert!(stream_len(0, 0.0, &[]) > 0 && stream_len(0, 0.0, &row(0.0)[..1]) > 0);
    }
}
