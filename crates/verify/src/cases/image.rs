//! Images of scenes.

use super::rays::aim;
use super::{Reach, point};
use crate::Numbers;
use accel::input::check_ray;
use accel::{Raster, Scene, View};

/// Most rows and columns.
const SIDE: u32 = 256;

/// An image of the scene, from as far as rays begin; none where structures don't accept each of its rays.
pub fn image(numbers: &mut impl Numbers, scene: &Scene, reach: &Reach) -> Option<Raster> {
    image_up_to(numbers, scene, reach, SIDE)
}

/// [`image`] of few rows and columns.
pub fn small_image(numbers: &mut impl Numbers, scene: &Scene, reach: &Reach) -> Option<Raster> {
    image_up_to(numbers, scene, reach, 12)
}

fn image_up_to(numbers: &mut impl Numbers, scene: &Scene, reach: &Reach, most: u32) -> Option<Raster> {
    let bounds = scene.geometry.bounds();
    let target = aim(numbers, scene)?;
    let size = bounds.extent().max_element();
    let eye = target + point(numbers) * size * 2f32.powi(reach.origins.min(FAR_OUT));
    let mut side = || 1 + numbers.below(most);
    let (rows, cols) = (side(), side());
    let up = point(numbers);
    let away = f64::from((eye - target).length());
    // From a little more than all of the scene to a part of it.
    let seen = f64::from(size) * 1.2 * f64::from(2f32.powi(-(numbers.below(4) as i32)));
    let fov_y_degrees = (2.0 * (0.5 * seen / away).atan()).to_degrees() as f32;
    let view = View { eye, target, up, fov_y_degrees };
    let raster = if numbers.below(3) == 0 {
        Raster::parallel(view.axes(), eye.as_dvec3(), seen / f64::from(rows.max(cols)), rows, cols)
    } else {
        Raster::perspective(&view, rows, cols)
    };
    let accepted = |row| (0..cols).all(|col| check_ray(&bounds, &raster.ray(row, col)).is_ok());
    (0..rows).all(accepted).then_some(raster)
}

/// Twos in the distance, in sizes of a scene, from which on neighbouring pixels are in the same place.
const FAR_OUT: i32 = 20;
