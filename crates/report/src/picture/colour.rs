//! Colours of pictures.

use accel::Vec3;
use image::Rgba;

/// Where nothing is hit.
pub const NOTHING: Rgba<u8> = Rgba([0, 0, 0, 0]);

/// A colour of linear intensities in [0, 1], encoded as sRGB (IEC 61966-2-1).
pub fn srgb(linear: Vec3) -> Rgba<u8> {
    let encode = |x: f32| {
        let x = x.clamp(0.0, 1.0);
        let y = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (y * 255.0).round() as u8
    };
    Rgba([encode(linear.x), encode(linear.y), encode(linear.z), 255])
}

/// A colour for an object: neighbours in number are far apart in hue.
pub fn of_object(object: u32) -> Vec3 {
    // Fibonacci hashing: steps by the golden ratio's fraction fill the circle of hues evenly.
    let hue = object.wrapping_mul(0x9E37_79B9) as f32 / 2f32.powi(32) * 6.0;
    let ramp = |offset: f32| ((hue + offset).rem_euclid(6.0) - 3.0).abs().clamp(1.0, 2.0) - 1.0;
    Vec3::splat(0.2) + Vec3::new(ramp(0.0), ramp(4.0), ramp(2.0)) * 0.7
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_keeps_the_ends_and_the_middle() {
        assert_eq!(srgb(Vec3::ZERO).0, [0, 0, 0, 255]);
        assert_eq!(srgb(Vec3::splat(2.0)).0, [255; 4]);
        assert_eq!(srgb(Vec3::splat(0.215_86)).0[0], 128);
    }

    #[test]
    fn neighbours_look_different() {
        for object in 0..1000 {
            assert!((of_object(object) - of_object(object + 1)).abs().max_element() > 0.2, "{object}");
        }
    }
}
