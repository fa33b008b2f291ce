//! Uniform subdivision of space: slices per axis, and which of them a box touches.
//!
//! All arithmetic is done in coordinates in which the grid is the unit cube, so that it
//! works at any scale and offset. Boxes are registered [`MARGIN`] wider than they are, which is
//! more than the rounding of a walk through the grid ([`crate::dda`]): whatever cell
//! the exact ray meets a box in, the walk visits one in which the box is registered.

pub use crate::tolerance::GRID_MARGIN as MARGIN;
use crate::tolerance::{LIMIT_S, LIMIT_T, T_SLACK};
use crate::{Aabb, Ray, Vec3};
use std::ops::Range;

/// A box divided into `resolution[a]` slices of equal thickness along each axis a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    bounds: Aabb,
    resolution: [u32; 3],
    /// One over the extent; 0 where there is none.
    inverse: [f64; 3],
}

/// Why there is no grid of that resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// Fewer than one or more than [`Grid::MOST_SLICES`] slices.
    #[error("{0} slices along an axis; there must be from 1 to {most}", most = Grid::MOST_SLICES)]
    Slices(u32),
}

/// The part of a ray inside a grid, in the grid's unit coordinates, as
/// `start + s·delta` with s from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where the ray enters, or begins.
    pub start: Vec3,
    /// From there to where it leaves, or ends.
    pub delta: Vec3,
    t_start: f64,
    t_span: f64,
}

impl Grid {
    /// Most slices along an axis: thinner ones would come near to [`MARGIN`].
    pub const MOST_SLICES: u32 = 1 << 14;

    /// Divides `bounds`, which must hold the boxes of all objects.
    ///
    /// # Errors
    /// [`GridError::Slices`] if a resolution is out of range.
    pub fn new(bounds: Aabb, resolution: [u32; 3]) -> Result<Self, GridError> {
        match resolution.into_iter().find(|n| !(1..=Self::MOST_SLICES).contains(n)) {
            Some(n) => Err(GridError::Slices(n)),
            None => {
                let extent = bounds.max.as_dvec3() - bounds.min.as_dvec3();
                let inverse = extent.to_array().map(|e| if e > 0.0 { 1.0 / e } else { 0.0 });
                Ok(Self { bounds, resolution, inverse })
            }
        }
    }

    /// The divided box.
    pub const fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Slices along each axis, N in the paper.
    pub const fn resolution(&self) -> [u32; 3] {
        self.resolution
    }

    /// Number of cells (supervoxels).
    pub const fn cells(&self) -> u64 {
        let [x, y, z] = self.resolution;
        x as u64 * y as u64 * z as u64
    }

    /// A cell's number, x running fastest.
    #[inline]
    pub const fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.resolution;
        (z as usize * ny as usize + y as usize) * nx as usize + x as usize
    }

    /// A coordinate in units of the grid's extent: 0 at its lower side, 1 at its upper.
    #[inline(always)]
    pub fn unit(&self, axis: usize, value: f64) -> f64 {
        (value - f64::from(self.bounds.min[axis])) * self.inverse[axis]
    }

    /// The slices that a box touches along an axis, conservatively.
    #[inline]
    pub fn slices(&self, axis: usize, bounds: &Aabb) -> Range<u32> {
        let n = self.resolution[axis];
        let of = |value: f64| (value * f64::from(n)).clamp(0.0, f64::from(n - 1)) as u32;
        let low = self.unit(axis, f64::from(bounds.min[axis])) - MARGIN;
        let high = self.unit(axis, f64::from(bounds.max[axis])) + MARGIN;
        of(low)..of(high) + 1
    }

    /// The part of the ray inside the grid and its own range of t, or `None` where there is none.
    #[inline(always)]
    pub fn clip(&self, ray: &Ray) -> Option<Segment> {
        let (near, far) = self.bounds.overlap(ray.origin, ray.direction)?;
        let t_start = near.max(f64::from(ray.t_min));
        let t_end = far.min(f64::from(ray.t_max));
        // A hit may lie a little outside of its box's range of t.
        let slack = T_SLACK * t_start.abs().max(t_end.abs());
        if t_start > t_end + slack {
            return None;
        }
        let t_end = t_end.max(t_start);
        let (mut start, mut delta) = (Vec3::ZERO, Vec3::ZERO);
        for axis in 0..3 {
            let (origin, direction) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
            let from = self.unit(axis, origin + t_start * direction).clamp(0.0, 1.0);
            let to = self.unit(axis, origin + t_end * direction).clamp(0.0, 1.0);
            start[axis] = from as f32;
            delta[axis] = (to - from) as f32;
        }
        Some(Segment { start, delta, t_start, t_span: t_end - t_start })
    }
}

impl Segment {
    /// An upper bound of the place s up to which objects must be looked at, when a hit at
    /// `t` is known: what begins behind it can't come before that hit.
    #[inline(always)]
    pub fn limit(&self, t: f32) -> f32 {
        self.limit_with(t, LIMIT_T, LIMIT_S)
    }

    #[inline(always)]
    pub(crate) fn limit_with(&self, t: f32, limit_t: f64, limit_s: f64) -> f32 {
        let t = f64::from(t);
        if t == f64::INFINITY || self.t_span == 0.0 {
            return f32::INFINITY;
        }
        let slack = limit_t * t.abs();
        (((t - self.t_start + slack) / self.t_span) as f32) * (1.0 + 4.0 * f32::EPSILON) + limit_s as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_cover_the_whole_range_and_never_leave_it() {
        let grid = Grid::new(Aabb { min: Vec3::ZERO, max: Vec3::splat(8.0) }, [8, 4, 1]).unwrap();
        let inside = Aabb { min: Vec3::splat(1.5), max: Vec3::splat(3.5) };
        assert_eq!([0, 1, 2].map(|a| grid.slices(a, &inside)), [1..4, 0..2, 0..1]);
        let touching = Aabb { min: Vec3::splat(2.0), max: Vec3::splat(2.0) };
        assert_eq!(grid.slices(0, &touching), 1..3, "a box in a slice plane is in both slices");
        assert_eq!(grid.slices(0, grid.bounds()), 0..8);
    }

    #[test]
    fn resolution_is_checked() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        assert_eq!(Grid::new(bounds, [4, 0, 4]), Err(GridError::Slices(0)));
        assert!(Grid::new(bounds, [1, Grid::MOST_SLICES, 1]).is_ok());
    }

    #[test]
    fn clipping_works_at_any_scale() {
        for scale in [2f32.powi(-100), 1.0, 2f32.powi(100)] {
            let bounds = Aabb { min: Vec3::ZERO, max: Vec3::splat(scale) };
            let grid = Grid::new(bounds, [2, 2, 2]).unwrap();
            let ray = Ray::new(Vec3::new(-scale, scale * 0.5, scale * 0.25), Vec3::X);
            let segment = grid.clip(&ray).unwrap();
            assert_eq!((segment.start, segment.delta), (Vec3::new(0.0, 0.5, 0.25), Vec3::X));
            assert!(segment.limit(1.5 * scale) >= 0.5 && segment.limit(1.5 * scale) < 0.501);
        }
    }
}
