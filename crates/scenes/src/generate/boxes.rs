//! The paper's experiment: axis-aligned boxes of one size in the image's cube
//! (Skala 1993, §6).

use crate::random::Random;
use crate::solid::round;
use accel::Aabb;
use glam::DVec3;

/// Image pixels along the unit cube's side in the paper's experiment.
pub const PIXELS: f64 = 256.0;

/// `count` boxes whose cross-section in the image is a square of `side` pixels, the unit
/// cube being [`PIXELS`] pixels wide. Centres are uniform over the cube, the boxes as deep
/// as they are wide and clipped at the cube's faces.
pub fn boxes(count: u32, side: f64, seed: u64) -> Vec<Aabb> {
    let mut random = Random::new(seed);
    let half = DVec3::splat(0.5 * side / PIXELS);
    (0..count)
        .map(|_| {
            let center = random.in_cube(0.0, 1.0);
            let clip = |p: DVec3| round(p.clamp(DVec3::ZERO, DVec3::ONE));
            Aabb { min: clip(center - half), max: clip(center + half) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_cross_section_is_that_of_table_6() {
        let (p, s) = (20_000, 25.0);
        let boxes = boxes(p, s, 3);
        let width = |b: &Aabb| f64::from(b.max.x - b.min.x) * PIXELS;
        let mean = boxes.iter().map(width).sum::<f64>() / f64::from(p);
        // Clipping at both borders takes s²/4·256 pixels from the mean width.
        let expected = s - s * s / 1024.0;
        assert!((mean / expected - 1.0).abs() < 0.005, "{mean} {expected}");
        assert!(boxes.iter().all(|b| b.min.min_element() >= 0.0 && b.max.max_element() <= 1.0));
    }
}
