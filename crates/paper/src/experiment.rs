//! The paper's experiment (Skala 1993, §6): boxes of one size at random in an image of 256 × 256 rays.
//!
//! The paper doesn't say how its boxes lie. Table 6 does: its means fit squares with corners on
//! the raster of rays, closed, so that a side of s pixels covers s + 1 rays, centres uniform
//! over the image, clipped at its border.

use accel::{Aabb, Geometry, Projection, Raster, Scene, Vec3, View};
use scenes::Random;

/// Rows and columns of the image, n = m in the paper.
pub const IMAGE: u32 = 256;

/// What a box covers of the image: first and last ray, closed. Ray (i, j) is at (j, i).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Square {
    /// First and last column.
    pub cols: [u32; 2],
    /// First and last row.
    pub rows: [u32; 2],
}

/// `count` squares of `side` pixels.
pub fn squares(count: u32, side: u32, seed: u64) -> Vec<Square> {
    let mut random = Random::new(seed);
    let mut range = || {
        let most = f64::from(IMAGE) - 1.0;
        // The rays are at the middle of pixels: a centre is anywhere in [-½, 255½).
        let center = random.range(-0.5, f64::from(IMAGE) - 0.5);
        let low = (center - 0.5 * f64::from(side) + 0.5).floor();
        [low.clamp(0.0, most) as u32, (low + f64::from(side)).clamp(0.0, most) as u32]
    };
    (0..count).map(|_| Square { cols: range(), rows: range() }).collect()
}

/// The closed form of Table 6: the mean number of squares over a ray.
///
/// A square covers w = (s+1) − (s+1)²/1024 rays of a row on average, the border taking the
/// second term, so the mean is p·w²/65536.
pub fn expected_mean(count: u32, side: u32) -> f64 {
    let closed = f64::from(side) + 1.0;
    let covered = closed - closed * closed / (4.0 * f64::from(IMAGE));
    f64::from(count) * covered * covered / f64::from(IMAGE).powi(2)
}

/// Boxes whose cross-section in the image are the squares, for rays along +z.
pub fn parallel(squares: &[Square], seed: u64) -> (Scene, Raster) {
    let mut random = Random::new(seed ^ 0xdee9);
    let boxes = squares.iter().map(|square| {
        let z = random.range(0.0, f64::from(IMAGE)) as f32;
        let depth = (square.cols[1] - square.cols[0]) as f32;
        Aabb {
            min: Vec3::new(square.cols[0] as f32, square.rows[0] as f32, z),
            max: Vec3::new(square.cols[1] as f32, square.rows[1] as f32, z + depth),
        }
    });
    let raster = Raster {
        projection: Projection::Parallel,
        rows: IMAGE,
        cols: IMAGE,
        origin: Vec3::new(-0.5, -0.5, -1.0),
        forward: Vec3::Z,
        right: Vec3::X,
        down: Vec3::Y,
    };
    (scene(boxes.collect()), raster)
}

/// Boxes whose front face covers the squares in the image of an eye at the origin that looks along +z with a
/// full angle of 2·atan ½; a box is as deep as its face is wide.
pub fn perspective(squares: &[Square], seed: u64) -> (Scene, Raster) {
    let mut random = Random::new(seed ^ 0xdee9);
    let boxes = squares.iter().map(|square| {
        let z = random.range(2.0, 4.0);
        let at = |ray: u32| (z * (f64::from(ray) + 0.5 - f64::from(IMAGE) / 2.0) / f64::from(IMAGE)) as f32;
        let [x, y] = [square.cols.map(at), square.rows.map(at)];
        let z = z as f32;
        Aabb { min: Vec3::new(x[0], y[0], z), max: Vec3::new(x[1], y[1], z + (x[1] - x[0])) }
    });
    let pixel = 1.0 / IMAGE as f32;
    let raster = Raster {
        projection: Projection::Perspective,
        rows: IMAGE,
        cols: IMAGE,
        origin: Vec3::ZERO,
        forward: Vec3::new(-0.5, -0.5, 1.0),
        right: Vec3::X * pixel,
        down: Vec3::Y * pixel,
    };
    (scene(boxes.collect()), raster)
}

/// A scene of boxes that is looked at through rasters of its own.
pub fn scene(boxes: Vec<Aabb>) -> Scene {
    let view = View { eye: Vec3::ZERO, target: Vec3::Z, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "experiment".into(), geometry: Geometry::Boxes(boxes), view }
}

#[cfg(test)]
mod tests {
    use super::super::printed::{OBJECTS, SIDES, TABLE_6};
    use super::*;
    use bmssm::suite::dense::ImageMaps;
    use primitives::Boxes;

    #[test]
    fn squares_have_their_side_unless_clipped() {
        for square in squares(2000, 25, 1) {
            for [low, high] in [square.cols, square.rows] {
                assert!(high < IMAGE && (high - low == 25 || low == 0 || high == IMAGE - 1));
            }
        }
    }

    #[test]
    fn the_closed_form_is_within_two_percent_of_the_print() {
        for (p, row) in OBJECTS.iter().zip(*TABLE_6) {
            for (s, printed) in SIDES.iter().zip(row) {
                let ratio = expected_mean(*p, *s) / printed;
                assert!((ratio - 1.0).abs() < 0.02, "p = {p}, s = {s}: {ratio}");
            }
        }
    }

    /// The maps of a parallel view of the boxes hold exactly the squares; those of a perspective view at least them.
    #[test]
    fn maps_of_the_boxes_hold_the_squares() {
        let squares = squares(100, 16, 7);
        for (scene, raster) in [parallel(&squares, 7), perspective(&squares, 7)] {
            let Geometry::Boxes(boxes) = &scene.geometry else { panic!("boxes") };
            let maps = ImageMaps::new(&Boxes::new(boxes), raster);
            for row in 0..IMAGE {
                let expected = |c: u32| {
                    let covers = |r: [u32; 2], at: u32| r[0] <= at && at <= r[1];
                    squares.iter().filter(|s| covers(s.rows, row) && covers(s.cols, c)).count() as u32
                };
                for col in (0..IMAGE).step_by(7) {
                    let found = maps.candidates(row, col);
                    match raster.projection {
                        Projection::Parallel => assert_eq!(found, expected(col)),
                        Projection::Perspective => assert!(found >= expected(col)),
                    }
                }
            }
        }
    }
}
