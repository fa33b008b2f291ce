//! Sets of rays: rasters and lists.

use crate::{Ray, Vec3};

/// How a raster's rays leave the image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays share one direction; the observer is in infinity (Skala 1993, fig. 1).
    Parallel,
    /// All rays leave one eye (Skala 1993, §4).
    Perspective,
}

/// The primary rays of an image: `rows × cols` pixels, one ray through each centre.
///
/// With `p(y, x) = corner + (x + ½)·right + (y + ½)·down` for row y and column x, a parallel
/// ray starts at p and runs along `forward`; a perspective ray starts at `corner_eye` and
/// runs towards `forward + p-offset`. Row planes hold all rays of a row, column planes
/// all of a column (Skala 1993, §2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    /// Parallel or perspective.
    pub projection: Projection,
    /// Image rows, n in the paper.
    pub rows: u32,
    /// Image columns, m in the paper.
    pub cols: u32,
    /// Perspective: the eye. Parallel: the outer corner of pixel (0, 0) on the image plane.
    pub origin: Vec3,
    /// Parallel: every ray's direction. Perspective: from the eye to the outer corner of pixel (0, 0).
    pub forward: Vec3,
    /// Step of one column.
    pub right: Vec3,
    /// Step of one row.
    pub down: Vec3,
}

impl Raster {
    /// Number of rays.
    #[inline]
    pub fn len(&self) -> usize {
        self.rows as usize * self.cols as usize
    }

    /// Whether the raster has no pixel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The ray of row `row` and column `col`: exactly this arithmetic, component by
    /// component, wherever a raster's rays are made, so that all structures see equal rays.
    #[inline]
    pub fn ray(&self, row: u32, col: u32) -> Ray {
        let x = col as f32 + 0.5;
        let y = row as f32 + 0.5;
        let offset = self.right * x + self.down * y;
        match self.projection {
            Projection::Parallel => Ray::new(self.origin + offset, self.forward),
            Projection::Perspective => Ray::new(self.origin, self.forward + offset),
        }
    }

    /// What all rays have in common.
    pub const fn common(&self) -> Common {
        match self.projection {
            Projection::Parallel => Common::Direction(self.forward),
            Projection::Perspective => Common::Origin(self.origin),
        }
    }
}

/// What all rays of a raster have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Common {
    /// One direction: parallel projection.
    Direction(Vec3),
    /// One origin: perspective projection.
    Origin(Vec3),
}

/// Rays to trace.
#[derive(Clone, Debug, PartialEq)]
pub enum RaySet {
    /// The primary rays of an image, row by row.
    Raster(Raster),
    /// Rays in no particular order.
    List(Vec<Ray>),
}

impl RaySet {
    /// Number of rays.
    pub fn len(&self) -> usize {
        match self {
            Self::Raster(raster) => raster.len(),
            Self::List(list) => list.len(),
        }
    }

    /// Whether there is no ray.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Ray number `index`; a raster counts row by row.
    ///
    /// # Panics
    /// If `index` is not below [`RaySet::len`].
    #[inline]
    pub fn ray(&self, index: usize) -> Ray {
        match self {
            Self::Raster(raster) => {
                assert!(index < raster.len(), "ray {index} of {}", raster.len());
                let cols = raster.cols as usize;
                raster.ray((index / cols) as u32, (index % cols) as u32)
            }
            Self::List(list) => list[index],
        }
    }
}
