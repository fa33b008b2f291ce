//! The set-up cost (n+m)·p·c₀ (Skala 1993, §3).

use super::experiment::{self, IMAGE};
use super::printed::{OBJECTS, SIDES};
use super::speed::APPENDIX_NS;
use super::table::{Table, grid};
use super::timing::medians;
use accel::Geometry;
use bmssm::suite::dense::ImageMaps;
use primitives::Boxes;
use std::hint::black_box;

/// Rounds of each timing.
const ROUNDS: usize = 5;

/// Nanoseconds to make the maps of an image of `objects` boxes of `side` pixels.
fn build_ns(objects: u32, side: u32) -> f64 {
    let (scene, raster) = experiment::parallel(&experiment::squares(objects, side, 1993), 1993);
    let Geometry::Boxes(boxes) = &scene.geometry else { return f64::NAN };
    let boxes = Boxes::new(boxes);
    medians(ROUNDS, &mut [&mut |_| drop(black_box(ImageMaps::new(&boxes, raster)))])[0]
}

/// c₀ in ns, and what the set-up is of an image; `two` is Table 2, which knows the image's time.
pub fn table(two: &Table) -> Table {
    let ns: Vec<Vec<f64>> = OBJECTS.map(|p| SIDES.map(|s| build_ns(p, s)).to_vec()).to_vec();
    let slices = f64::from(2 * IMAGE);
    let c0 = grid(|row, col| ns[row][col] / (slices * f64::from(OBJECTS[row])));
    let rays = f64::from(IMAGE * IMAGE);
    let trace = two.variants.get(APPENDIX_NS);
    let share =
        |row: usize, col: usize| trace.map_or(f64::NAN, |t| 100.0 * ns[row][col] / (t[row][col] * rays));
    let of = |values: &[Vec<f64>]| {
        let all = || values.iter().flatten().copied();
        [all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max)]
    };
    let ([low, high], [least, most]) = (of(&c0), of(&grid(share)));
    Table::of_cells("c₀, the set-up cost of an object in a slice, in ns", "objects", &[[f64::NAN; 6]; 7], c0)
        .with("µs to make R and S", grid(|row, col| ns[row][col] / 1e3))
        .with("% of the time of one image by the appendix loop", grid(share))
        .remark(format!(
            "§3 counts (n+m)·p·c₀ and prints no c₀. Here it is {low:.3} to {high:.3} ns, so no constant: a box sets bits in the \
             slices that it meets and in no others, and clearing the maps is cheap. Making the maps takes {least:.2} to {most:.1} % of \
             the time of one image."
        ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_take_time_to_make() {
        // No time is asserted, only that there is one.
        assert!(build_ns(400, 10) > 0.0);
    }
}
