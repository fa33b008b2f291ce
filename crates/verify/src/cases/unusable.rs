//! Rays that structures turn down, or should never have been given.

use crate::Numbers;
use accel::{Raster, Ray, Vec3};

/// What no coordinate of a ray is.
const WRONG: [f32; 4] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -f32::NAN];

/// The ray with one part spoiled or several, so that [`Ray::validate`] turns it down.
pub fn unusable(numbers: &mut impl Numbers, ray: Ray) -> Ray {
    let mut ray = ray;
    loop {
        match numbers.below(8) {
            0 => ray.origin = spoiled(numbers, ray.origin),
            1..4 => ray.direction = spoiled(numbers, ray.direction),
            4 => ray.direction = Vec3::ZERO * numbers.one_of(&[1.0, -1.0]),
            5 => ray.t_min = numbers.one_of(&WRONG),
            6 => ray.t_max = numbers.one_of(&WRONG),
            // Alone these are sound; with a part that is not they take other ways.
            _ => ray.t_max = numbers.one_of(&[7.0, 0.0, f32::MAX]),
        }
        if ray.validate().is_err() && numbers.below(2) == 0 {
            return ray;
        }
    }
}

/// The image with a part spoiled, so that none of its rays is one.
pub fn unusable_image(numbers: &mut impl Numbers, raster: Raster) -> Raster {
    let mut raster = raster;
    match numbers.below(5) {
        0 => raster.origin = spoiled(numbers, raster.origin),
        1 => raster.forward = spoiled(numbers, raster.forward),
        2 => raster.right = spoiled(numbers, raster.right),
        3 => raster.down = spoiled(numbers, raster.down),
        _ => (raster.forward, raster.right, raster.down) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO),
    }
    raster
}

/// One coordinate or more that are none.
fn spoiled(numbers: &mut impl Numbers, point: Vec3) -> Vec3 {
    let mut point = point;
    let axis = numbers.below(3) as usize;
    point[axis] = numbers.one_of(&WRONG);
    for other in [(axis + 1) % 3, (axis + 2) % 3] {
        match numbers.below(4) {
            0 => point[other] = numbers.one_of(&WRONG),
            1 => point[other] = 0.0,
            _ => {}
        }
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bytes;
    use scenes::Random;

    #[test]
    fn nothing_that_comes_out_is_a_ray() {
        let sound = Ray::new(Vec3::ONE, Vec3::X);
        let mut numbers = Random::new(1);
        for _ in 0..1000 {
            assert!(unusable(&mut numbers, sound).validate().is_err());
        }
        for bytes in 0..=u8::MAX {
            assert!(unusable(&mut Bytes(&[bytes]), sound).validate().is_err());
        }
    }
}
