use super::*;
use crate::Vec3;
use proptest::prelude::*;

/// A 10 × 8 image on the plane z = 0, one pixel a unit, looking along +z.
fn parallel() -> Raster {
    Raster {
        projection: Projection::Parallel,
        rows: 8,
        cols: 10,
        origin: Vec3::ZERO,
        forward: Vec3::Z,
        right: Vec3::X,
        down: Vec3::Y,
    }
}

/// A 10 × 8 image seen from the origin along +z, a pixel a unit at distance 5.
fn perspective() -> Raster {
    let corner = Vec3::new(-5.0, -4.0, 5.0);
    Raster { projection: Projection::Perspective, forward: corner, ..parallel() }
}

fn seen(raster: &Raster, min: [f32; 3], max: [f32; 3]) -> Pixels {
    ImageSpace::new(raster).pixels(&Aabb { min: Vec3::from(min), max: Vec3::from(max) })
}

#[test]
fn parallel_ranges_hold_the_centres_inside_the_box_and_no_others() {
    let pixels = seen(&parallel(), [3.2, 2.6, 2.0], [5.7, 3.4, 3.0]);
    assert_eq!((pixels.cols.clone(), pixels.rows.clone()), (3..6, 0..0), "3.5, 4.5, 5.5; no row centre");
    assert!(pixels.is_empty());
    assert!(pixels.near > 1.9999 && pixels.near <= 2.0);
    let beyond = seen(&parallel(), [-9.0, 7.0, 2.0], [-1.0, 70.0, 3.0]);
    assert_eq!((beyond.cols, beyond.rows), (0..0, 7..8));
}

#[test]
fn perspective_ranges_divide_by_depth() {
    let pixels = seen(&perspective(), [0.6, -0.1, 10.0], [3.4, 3.0, 10.5]);
    assert_eq!((pixels.cols, pixels.rows), (5..7, 4..6), "x / z · 5 + 5 from 5.29 to 6.7");
    assert!(pixels.near > 1.9999 && pixels.near <= 2.0, "t counts in units of the direction");
}

#[test]
fn bounds_of_t_are_never_negative() {
    let raster = Raster { forward: Vec3::new(-5.0, -4.0, 1e4), ..perspective() };
    let least = f32::from_bits(1);
    assert_eq!(seen(&raster, [0.0, 0.0, least], [0.0, 0.0, 2.0 * least]).near.to_bits(), 0);
    assert_eq!(seen(&parallel(), [0.0; 3], [0.0, 0.0, least]).near.to_bits(), 0);
}

#[test]
fn what_lies_behind_the_eye_is_seen_by_no_ray() {
    assert!(seen(&perspective(), [-1.0, -1.0, -9.0], [1.0, 1.0, -8.0]).is_empty());
}

#[test]
fn boxes_across_the_eye_plane_reach_to_the_side_they_are_on() {
    let around = seen(&perspective(), [-1.0; 3], [1.0; 3]);
    assert_eq!((around.cols, around.rows), (0..10, 0..8));
    assert_eq!(around.near, 0.0);
    let right = seen(&perspective(), [2.1, -1.0, -10.0], [3.0, 1.0, 5.0]);
    assert_eq!((right.cols, right.rows), (7..10, 0..8));
    let touching = seen(&perspective(), [2.1, -1.0, 0.0], [3.0, 1.0, 5.0]);
    assert_eq!(touching.cols, 7..10);
}

#[test]
fn a_flat_frame_sees_everything() {
    let flat = Raster { down: Vec3::X, ..parallel() };
    assert_eq!(seen(&flat, [20.0; 3], [21.0; 3]).cols, 0..10);
}

fn point(range: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(prop_oneof![4 => -range..range, 1 => Just(0.0), 1 => Just(range)])
        .prop_map(Vec3::from_array)
}

fn frame() -> impl Strategy<Value = [Vec3; 3]> {
    prop_oneof![
        Just([Vec3::Z, Vec3::X * 0.25, Vec3::Y * 0.25]),
        Just([Vec3::NEG_X, Vec3::Y * 0.125, Vec3::NEG_Z * 0.25]),
        [point(1.0), point(0.2), point(0.2)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Whatever pixel's ray meets a box is inside the box's range, and the hit not before its near bound;
    /// at any scale, near the origin and far from it.
    #[test]
    fn no_pixel_is_lost(
        [forward, right, down] in frame(),
        origin in point(2.0),
        far in prop_oneof![3 => Just(0.0f32), 1 => Just(300.0), 1 => Just(1e5)],
        scale in prop_oneof![3 => Just(0), 1 => -60..60],
        boxes in prop::collection::vec((point(2.0), point(0.7)), 1..8),
        perspective: bool,
        tangent: bool,
    ) {
        let scale = 2f32.powi(scale);
        let shift = Vec3::new(far, -far, far * 0.5);
        let (rows, cols) = (9, 11);
        let projection = if perspective { Projection::Perspective } else { Projection::Parallel };
        let centred = right * (-0.5 * cols as f32) + down * (-0.5 * rows as f32);
        let (origin, forward) = match projection {
            Projection::Parallel => (origin + centred, forward),
            Projection::Perspective => (origin, forward + centred),
        };
        let raster = Raster {
            projection, rows, cols,
            origin: (origin + shift) * scale,
            forward: forward * scale,
            right: right * scale,
            down: down * scale,
        };
        let space = ImageSpace::new(&raster);
        for (index, (center, half)) in boxes.into_iter().enumerate() {
            let half = half.abs();
            let mut bounds = Aabb { min: center - half, max: center + half };
            if tangent {
                // A box that just touches some pixel's ray.
                let ray = raster.ray(index as u32, index as u32);
                let at = (ray.origin + ray.direction * (index as f32 * 0.5 - 1.0)) / scale - shift;
                bounds = Aabb { min: at, max: at + half };
            }
            let bounds = Aabb { min: (bounds.min + shift) * scale, max: (bounds.max + shift) * scale };
            let pixels = space.pixels(&bounds);
            for (row, col) in (0..rows).flat_map(|row| (0..cols).map(move |col| (row, col))) {
                let ray = raster.ray(row, col);
                if ray.direction == Vec3::ZERO {
                    continue;
                }
                if let Some((near, exit)) = bounds.overlap(ray.origin, ray.direction) && exit >= 0.0 {
                    prop_assert!(
                        pixels.rows.contains(&row) && pixels.cols.contains(&col),
                        "ray ({row}, {col}) meets {bounds:?}, but only {pixels:?} may"
                    );
                    let first = near.max(0.0) * (1.0 - crate::tolerance::T_SLACK);
                    prop_assert!(f64::from(pixels.near) <= first, "{pixels:?} but t = {near}");
                }
            }
        }
    }
}

#[test]
fn every_ray_has_its_pixel_and_others_have_none() {
    // The last is a line of pixels, and places along it are lost in rounding.
    let far = Raster { origin: Vec3::splat(3e5), down: Vec3::ZERO, ..parallel() };
    for raster in [parallel(), perspective(), far] {
        for (row, col) in (0..8).flat_map(|row| (0..10).map(move |col| (row, col))) {
            let ray = raster.ray(row, col);
            let (row, col) = pixel_of(&raster, &ray).expect("a ray of the raster");
            assert_eq!(raster.ray(row, col), ray);
            let beside = crate::Ray { direction: ray.direction + Vec3::new(0.0, 0.0, 0.001), ..ray };
            assert_eq!(pixel_of(&raster, &beside), None);
        }
    }
}
