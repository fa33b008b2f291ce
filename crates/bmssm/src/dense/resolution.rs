//! How many slices there are on each axis.

use accel::grid::Grid;
use accel::{Aabb, Bounds};
use std::fmt;

/// The rule by which N is chosen for the maps of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolution {
    /// From the scene: the power of two along the longest axis with the least expected cost of a ray.
    Auto,
    /// So many slices on each axis, but one on a flat axis.
    Same(u32),
    /// So many slices along x, y and z.
    Each([u32; 3]),
}

/// Time of a detail test in units of the time to combine a word of three maps.
const TEST_COST: f64 = 16.0;

/// An axis is flat if the scene's extent on it is less than this part of its largest extent: padding only.
const FLAT: f64 = 1.0 / (1 << 14) as f64;

impl Resolution {
    /// Reads `auto`, `64`, or `64x32x16` for x, y and z.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let numbers: Result<Vec<u32>, _> = text.split('x').map(str::parse).collect();
        let resolution = match numbers.as_deref() {
            Ok([n]) => Self::Same(*n),
            Ok([x, y, z]) => Self::Each([*x, *y, *z]),
            _ => {
                return Err(format!("'{text}' is neither auto nor N nor NXxNYxNZ, such as 64 or 64x32x16"));
            }
        };
        resolution.check().map(|()| resolution)
    }

    /// Whether the numbers are in range.
    ///
    /// # Errors
    /// Says which is not.
    pub fn check(self) -> Result<(), String> {
        let wanted = match self {
            Self::Auto => return Ok(()),
            Self::Same(n) => [n; 3],
            Self::Each(each) => each,
        };
        match wanted.into_iter().find(|n| !(1..=Grid::MAX_SLICES).contains(n)) {
            Some(n) => Err(format!("{n} slices along an axis; there must be from 1 to {}", Grid::MAX_SLICES)),
            None => Ok(()),
        }
    }

    /// Slices along each axis for `objects` in `bounds`.
    pub fn slices<B: Bounds>(self, objects: &B, bounds: &Aabb) -> [u32; 3] {
        let extent = [0, 1, 2].map(|a| f64::from(bounds.max[a]) - f64::from(bounds.min[a]));
        let longest = extent.into_iter().fold(0.0, f64::max);
        let flat = |a: usize| extent[a] <= longest * FLAT;
        match self {
            Self::Each(each) => each,
            Self::Same(n) => [0, 1, 2].map(|a| if flat(a) { 1 } else { n }),
            Self::Auto => {
                let n = cheapest(objects, longest);
                [0, 1, 2].map(|a| {
                    if flat(a) { 1 } else { (f64::from(n) * extent[a] / longest).ceil().max(1.0) as u32 }
                })
            }
        }
    }
}

/// The N with the least cost of a ray through the middle of a cube: about 1.5·N cells with p/64 words each,
/// and a test for every object whose box, widened by a cell, it meets.
fn cheapest<B: Bounds>(objects: &B, longest: f64) -> u32 {
    let mean_size = {
        let size = |id| f64::from(objects.bounds(id).extent().element_sum()) / 3.0;
        let sum: f64 = (0..objects.len() as u32).map(size).sum();
        if longest > 0.0 { sum / objects.len().max(1) as f64 / longest } else { 1.0 }
    };
    let cost = |n: u32| {
        let n = f64::from(n);
        let words = 1.5 * n / 64.0;
        let cells_met = (mean_size * n + 1.0).powi(2);
        words + TEST_COST * cells_met / (n * n)
    };
    let powers = (0..=8).map(|power| 1u32 << power);
    powers.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(1)
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Same(n) => write!(f, "{n}"),
            Self::Each([x, y, z]) => write!(f, "{x}x{y}x{z}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;
    use primitives::Boxes;

    #[test]
    fn settings_are_read_and_written_alike() {
        for text in ["auto", "64", "64x32x16", "1"] {
            assert_eq!(Resolution::parse(text).unwrap().to_string(), text);
        }
        for text in ["0", "64x2", "4x0x4", "", "-1", "16385", "99999999999"] {
            assert!(Resolution::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_flat_axis_has_one_slice_and_small_objects_many() {
        let cubes = |side: f32, height: f32| -> Vec<Aabb> {
            let places =
                (0..1000).map(|i| Vec3::new((i % 10) as f32, (i / 10 % 10) as f32, (i / 100) as f32));
            places
                .map(|at| at * Vec3::new(1.0, 1.0, height))
                .map(|min| Aabb { min, max: min + Vec3::new(side, side, side * height) })
                .collect()
        };
        let slices = |boxes: &[Aabb], rule: Resolution| {
            let objects = Boxes::new(boxes);
            rule.slices(&objects, &accel::Bounds::hull(&objects))
        };
        let flat = cubes(0.5, 0.0);
        assert_eq!(slices(&flat, Resolution::Same(16)), [16, 16, 1]);
        assert_eq!(slices(&flat, Resolution::Auto)[2], 1);
        assert_eq!(slices(&flat, Resolution::Each([4, 2, 3])), [4, 2, 3]);
        let small = slices(&cubes(0.1, 1.0), Resolution::Auto);
        assert!(small[0] >= 8 && small[0] == small[1], "{small:?}");
        let low = slices(&cubes(0.1, 0.25), Resolution::Auto);
        assert!(low[2] <= low[0] / 2, "{low:?}");
    }
}
