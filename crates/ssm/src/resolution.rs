//! How many slices a grid has on each axis.

use accel::grid::Grid;
use accel::parallel::prelude::*;
use accel::{Aabb, Bounds, BuildError, Vec3};
use std::fmt;

/// The rule by which a grid's resolution is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// So many slices on each axis.
    Slices([u32; 3]),
    /// So many cells for each object, the cells near to cubes: J. Cleary and G. Wyvill, *Analysis of an Algorithm for Fast Ray Tracing Using Uniform Space
    /// Subdivision*, The Visual Computer 4, 1988.
    Density(f64),
}

impl Resolution {
    /// Reads `64`, or `64x32x16` for x, y and z.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn parse_slices(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<u32>, _> = text.split('x').map(str::parse).collect();
        let slices = match numbers.as_deref() {
            Ok([n]) => [*n; 3],
            Ok([x, y, z]) => [*x, *y, *z],
            _ => return Err(format!("'{text}' is neither N nor NXxNYxNZ, such as 64 or 64x32x16")),
        };
        match slices.into_iter().find(|n| !(1..=Grid::MAX_SLICES).contains(n)) {
            Some(n) => Err(format!("{n} slices along an axis; there must be from 1 to {}", Grid::MAX_SLICES)),
            None => Ok(Self::Slices(slices)),
        }
    }

    /// Reads a number of cells for each object.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn parse_density(text: &str) -> Result<Self, String> {
        match text.parse::<f64>() {
            Ok(density) if density.is_finite() && density > 0.0 => Ok(Self::Density(density)),
            _ => Err(format!("'{text}' is not a number of cells for each object above 0")),
        }
    }

    /// Slices on each axis for `objects` objects in `bounds`.
    pub fn slices(self, bounds: &Aabb, objects: usize) -> [u32; 3] {
        match self {
            Self::Slices(slices) => slices,
            Self::Density(density) => by_density(bounds, objects as f64 * density),
        }
    }
}

/// Cubes as far as possible: the edge is such that `cells` of them fill the box, an axis
/// thinner than an edge having one slice.
fn by_density(bounds: &Aabb, cells: f64) -> [u32; 3] {
    let extent = [0, 1, 2].map(|a| f64::from(bounds.max[a]) - f64::from(bounds.min[a]));
    let mut long = [0, 1, 2];
    long.sort_by(|a, b| extent[*b].total_cmp(&extent[*a]));
    let cells = cells.max(1.0);
    let edge_over = |axes: usize| {
        let product: f64 = long[..axes].iter().map(|a| extent[*a] / extent[long[0]]).product();
        extent[long[0]] * (product / cells).powf(1.0 / axes as f64)
    };
    let axes = (1..=3).rev().find(|axes| extent[long[axes - 1]] >= edge_over(*axes)).unwrap_or(1);
    let edge = edge_over(axes);
    let most = f64::from(Grid::MAX_SLICES);
    extent.map(|e| if e > 0.0 && edge > 0.0 { (e / edge).round().clamp(1.0, most) as u32 } else { 1 })
}

/// The box of the padded boxes of all objects; some box where there are none.
pub(crate) fn bounds<B: Bounds>(objects: &B) -> Aabb {
    or_some(objects.hull())
}

/// The box of those objects that are wanted; some box where there are none.
pub(crate) fn bounds_of<B: Bounds>(objects: &B, wanted: impl Fn(u32) -> bool + Sync) -> Aabb {
    let each = (0..objects.len() as u32).into_par_iter().with_min_len(1 << 12);
    let each = each.filter(|id| wanted(*id)).map(|id| objects.bounds(id));
    or_some(each.reduce(|| Aabb::EMPTY, |a, b| a.union(b)))
}

fn or_some(bounds: Aabb) -> Aabb {
    if bounds.is_empty() { Aabb { min: Vec3::ZERO, max: Vec3::ONE } } else { bounds }
}

/// The grid that the rule gives.
///
/// # Errors
/// [`BuildError::Setting`] if its resolution is out of range.
pub(crate) fn grid(
    structure: &str,
    resolution: Resolution,
    bounds: Aabb,
    objects: usize,
) -> Result<Grid, BuildError> {
    let slices = resolution.slices(&bounds, objects);
    Grid::new(bounds, slices).map_err(|error| BuildError::Setting {
        structure: structure.into(),
        setting: "resolution".into(),
        problem: error.to_string(),
    })
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slices([x, y, z]) if x == y && y == z => write!(f, "resolution={x}"),
            Self::Slices([x, y, z]) => write!(f, "resolution={x}x{y}x{z}"),
            Self::Density(density) => write!(f, "density={density}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slices(extent: [f32; 3], objects: usize) -> [u32; 3] {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::from_array(extent) };
        Resolution::Density(1.0).slices(&bounds, objects)
    }

    #[test]
    fn density_gives_cubes() {
        assert_eq!(slices([1.0, 1.0, 1.0], 1000), [10, 10, 10]);
        assert_eq!(slices([4.0, 1.0, 2.0], 1000), [20, 5, 10]);
        assert_eq!(slices([1.0, 1e-9, 1.0], 10_000), [100, 1, 100]);
        assert_eq!(slices([1e-30, 1e-38, 1e-38], 50), [50, 1, 1]);
        assert_eq!(slices([0.0; 3], 7), [1, 1, 1]);
        assert_eq!(slices([1.0; 3], 0), [1, 1, 1]);
    }

    #[test]
    fn settings_are_read_and_written_alike() {
        for text in ["64", "64x32x16", "1"] {
            let resolution = Resolution::parse_slices(text).unwrap();
            assert_eq!(resolution.to_string(), format!("resolution={text}"));
        }
        for text in ["0", "-1", "64x2", "64x0x3", "", "x", "16385", "4294967296"] {
            assert!(Resolution::parse_slices(text).is_err(), "{text}");
        }
        for text in ["0", "-2", "NaN", "inf", "many"] {
            assert!(Resolution::parse_density(text).is_err(), "{text}");
        }
        assert_eq!(Resolution::parse_density("2.5"), Ok(Resolution::Density(2.5)));
    }
}
