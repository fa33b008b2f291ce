//! Uniform subdivision of space: slices per axis, and which of them a box touches.
//!
//! All arithmetic is done in coordinates in which the grid is the unit cube, so that it
//! works at any scale and offset. Boxes are registered [`MARGIN`] wider than they are, which is
//! more than the rounding of a walk through the grid ([`crate::dda`]): whatever cell
//! the exact ray meets a box in, the walk visits one in which the box is registered.

use crate::far::{BRIEFLY, Line, is_brief};
pub use crate::tolerance::GRID_MARGIN as MARGIN;
#[cfg(doc)]
use crate::tolerance::T_SLACK;
use crate::tolerance::{LIMIT_S, LIMIT_T, RANGE_SLACK, TOUCH};
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
    /// Fewer than one or more than [`Grid::MAX_SLICES`] slices.
    #[error("{0} slices along an axis; there must be from 1 to {most}", most = Grid::MAX_SLICES)]
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
    span: Span,
}

impl Grid {
    /// Most slices along an axis: thinner ones would come near to [`MARGIN`].
    pub const MAX_SLICES: u32 = 1 << 14;

    /// Divides `bounds`, which must hold the boxes of all objects.
    ///
    /// # Errors
    /// [`GridError::Slices`] if a resolution is out of range.
    pub fn new(bounds: Aabb, resolution: [u32; 3]) -> Result<Self, GridError> {
        match resolution.into_iter().find(|n| !(1..=Self::MAX_SLICES).contains(n)) {
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

    /// The coordinates that are 0 in units of the grid's extent, and units to a length of 1: (v − origin) · inverse is
    /// [`Grid::unit`] of v.
    #[inline(always)]
    pub fn to_unit(&self) -> ([f64; 3], [f64; 3]) {
        (self.bounds.min.as_dvec3().to_array(), self.inverse)
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
        match Line::unmoved(self.corners(), ray.origin, ray.direction) {
            Some(line) => self.clip_line(ray, &line),
            None => self.clip_moved(ray),
        }
    }

    /// [`Grid::clip`] of a ray from far away. Compiled apart, so that nearly all rays, whose origin stays where it is, add
    /// nothing to each t.
    #[cold]
    #[inline(never)]
    fn clip_moved(&self, ray: &Ray) -> Option<Segment> {
        self.clip_line(ray, &Line::moved(self.corners(), ray.origin, ray.direction))
    }

    #[inline(always)]
    const fn corners(&self) -> [Vec3; 2] {
        [self.bounds.min, self.bounds.max]
    }

    #[inline(always)]
    fn clip_line(&self, ray: &Ray, line: &Line) -> Option<Segment> {
        let (t_min, t_max) = within_reach(f64::from(ray.t_min), f64::from(ray.t_max));
        let t_start = line.near.max(t_min - line.moved);
        let t_end = line.far.min(t_max - line.moved);
        // Without end or beginning is only the range of a ray without direction.
        if t_start > t_end + TOUCH * line.scale(t_start, t_end) || !(t_start + t_end).is_finite() {
            return None;
        }
        let t_end = t_end.max(t_start);
        let (mut start, mut delta) = (Vec3::ZERO, Vec3::ZERO);
        for axis in 0..3 {
            let (origin, direction) = (line.origin[axis], f64::from(ray.direction[axis]));
            let from = self.unit(axis, origin + t_start * direction).clamp(0.0, 1.0);
            let to = self.unit(axis, origin + t_end * direction).clamp(0.0, 1.0);
            start[axis] = from as f32;
            delta[axis] = (to - from) as f32;
        }
        Some(Segment { start, delta, span: Span { t_start: line.moved + t_start, t_span: t_end - t_start } })
    }

    /// [`Grid::clip`] for several rays at once, with the same results.
    ///
    /// Loops over lanes without branches, which compilers turn into vectors of `f64`.
    #[inline(always)]
    pub fn clip_rows<const N: usize>(&self, rays: &RayRows<N>) -> SegmentRows<N> {
        let (mut near, mut far) = ([f64::NEG_INFINITY; N], [f64::INFINITY; N]);
        for axis in 0..3 {
            let (min, max) = (f64::from(self.bounds.min[axis]), f64::from(self.bounds.max[axis]));
            for i in 0..N {
                let (o, d) = (f64::from(rays.origin[axis][i]), f64::from(rays.direction[axis][i]));
                let (lo, hi) = (min - o, max - o);
                let inverse = 1.0 / d;
                let (a, b) = (lo * inverse, hi * inverse);
                let (least, most) = if a < b { (a, b) } else { (b, a) };
                // Along a plane, all or nothing.
                let inside = (lo <= 0.0) & (hi >= 0.0);
                let nothing = if inside { f64::NEG_INFINITY } else { f64::INFINITY };
                let least = if d == 0.0 { nothing } else { least };
                let most = if d == 0.0 { -nothing } else { most };
                near[i] = if least > near[i] { least } else { near[i] };
                far[i] = if most < far[i] { most } else { far[i] };
            }
        }
        let (mut brief, mut any_brief) = ([false; N], false);
        for i in 0..N {
            brief[i] = is_brief(near[i], far[i], BRIEFLY);
            any_brief |= brief[i];
        }
        let mut rows = SegmentRows {
            start: [[0.0; N]; 3],
            delta: [[0.0; N]; 3],
            t_start: [0.0; N],
            t_span: [0.0; N],
            met: [false; N],
        };
        let mut t_ends = [0.0; N];
        for i in 0..N {
            let (t_min, t_max) = within_reach(f64::from(rays.t_min[i]), f64::from(rays.t_max[i]));
            let t_start = if near[i] > t_min { near[i] } else { t_min };
            let t_end = if far[i] < t_max { far[i] } else { t_max };
            let (a, b) = (t_start.abs(), t_end.abs());
            let touch = TOUCH * if a > b { a } else { b };
            rows.met[i] = (t_start <= t_end + touch) & (t_start + t_end).is_finite();
            rows.t_start[i] = t_start;
            t_ends[i] = if t_end > t_start { t_end } else { t_start };
            rows.t_span[i] = t_ends[i] - t_start;
        }
        for axis in 0..3 {
            let (min, inverse) = (f64::from(self.bounds.min[axis]), self.inverse[axis]);
            for (i, t_end) in t_ends.iter().enumerate() {
                let (o, d) = (f64::from(rays.origin[axis][i]), f64::from(rays.direction[axis][i]));
                let from = within_unit((o + rows.t_start[i] * d - min) * inverse);
                let to = within_unit((o + t_end * d - min) * inverse);
                rows.start[axis][i] = from as f32;
                rows.delta[axis][i] = (to - from) as f32;
            }
        }
        if any_brief {
            self.clip_brief(rays, &brief, &mut rows);
        }
        rows
    }

    /// Clips the rays marked one by one.
    #[cold]
    fn clip_brief<const N: usize>(&self, rays: &RayRows<N>, which: &[bool; N], rows: &mut SegmentRows<N>) {
        for i in (0..N).filter(|i| which[*i]) {
            let segment = self.clip(&rays.ray(i));
            rows.met[i] = segment.is_some();
            if let Some(Segment { start, delta, span }) = segment {
                for axis in 0..3 {
                    (rows.start[axis][i], rows.delta[axis][i]) = (start[axis], delta[axis]);
                }
                (rows.t_start[i], rows.t_span[i]) = (span.t_start, span.t_span);
            }
        }
    }
}

/// The range of t in which a box may begin or end whose hit lies in this range: a hit may lie outside of its object's
/// box by [`T_SLACK`].
#[inline(always)]
pub fn within_reach(t_min: f64, t_max: f64) -> (f64, f64) {
    (t_min - RANGE_SLACK * t_min.abs(), t_max + RANGE_SLACK * t_max.abs())
}

#[inline(always)]
fn within_unit(value: f64) -> f64 {
    let value = if value > 0.0 { value } else { 0.0 };
    if value < 1.0 { value } else { 1.0 }
}

/// Several rays, coordinate by coordinate.
#[derive(Clone, Debug)]
pub struct RayRows<const N: usize> {
    /// Origins.
    pub origin: [[f32; N]; 3],
    /// Directions.
    pub direction: [[f32; N]; 3],
    /// Least t of each ray.
    pub t_min: [f32; N],
    /// Greatest t of each ray.
    pub t_max: [f32; N],
}

impl<const N: usize> RayRows<N> {
    /// The first N of `rays`; where there are fewer, the first stands in for the others.
    ///
    /// # Panics
    /// If there is none.
    #[inline(always)]
    pub fn load(rays: &[Ray]) -> Self {
        let mut rows =
            Self { origin: [[0.0; N]; 3], direction: [[0.0; N]; 3], t_min: [0.0; N], t_max: [0.0; N] };
        for lane in 0..N {
            let ray = rays.get(lane).unwrap_or(&rays[0]);
            for axis in 0..3 {
                rows.origin[axis][lane] = ray.origin[axis];
                rows.direction[axis][lane] = ray.direction[axis];
            }
            (rows.t_min[lane], rows.t_max[lane]) = (ray.t_min, ray.t_max);
        }
        rows
    }

    /// One of them.
    fn ray(&self, lane: usize) -> Ray {
        let at = |rows: &[[f32; N]; 3]| Vec3::new(rows[0][lane], rows[1][lane], rows[2][lane]);
        let (t_min, t_max) = (self.t_min[lane], self.t_max[lane]);
        Ray { origin: at(&self.origin), direction: at(&self.direction), t_min, t_max }
    }
}

impl Segment {
    /// Where it lies on its ray.
    #[inline(always)]
    pub const fn span(&self) -> Span {
        self.span
    }

    /// See [`Span::limit`].
    #[inline]
    pub fn limit(&self, t: f32) -> f32 {
        self.span.limit(t)
    }

    #[cfg(test)]
    pub(crate) fn limit_with(&self, t: f32, limit_t: f64, limit_s: f64) -> f32 {
        self.span.limit_with(t, limit_t, limit_s)
    }
}

/// Where a [`Segment`] lies on its ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Span {
    t_start: f64,
    t_span: f64,
}

impl Span {
    /// That of no segment.
    pub const NONE: Self = Self { t_start: 0.0, t_span: 0.0 };

    /// An upper bound of the place s up to which objects must be looked at, when a hit at
    /// `t` is known: what begins behind it can't come before that hit.
    #[inline(always)]
    pub fn limit(&self, t: f32) -> f32 {
        self.limit_with(t, LIMIT_T, LIMIT_S)
    }

    #[inline(always)]
    fn limit_with(&self, t: f32, limit_t: f64, limit_s: f64) -> f32 {
        let t = f64::from(t);
        if t == f64::INFINITY || self.t_span == 0.0 {
            return f32::INFINITY;
        }
        let slack = limit_t * t.abs();
        (((t - self.t_start + slack) / self.t_span) as f32) * (1.0 + 4.0 * f32::EPSILON) + limit_s as f32
    }
}

/// The segments of several rays, coordinate by coordinate.
#[derive(Clone, Debug)]
pub struct SegmentRows<const N: usize> {
    /// [`Segment::start`].
    pub start: [[f32; N]; 3],
    /// [`Segment::delta`].
    pub delta: [[f32; N]; 3],
    t_start: [f64; N],
    t_span: [f64; N],
    /// Whether there is a segment; where there is none, the other values mean nothing.
    pub met: [bool; N],
}

impl<const N: usize> SegmentRows<N> {
    /// Where the segment of one ray lies on it.
    #[inline(always)]
    pub fn span(&self, lane: usize) -> Span {
        Span { t_start: self.t_start[lane], t_span: self.t_span[lane] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
        assert!(Grid::new(bounds, [1, Grid::MAX_SLICES, 1]).is_ok());
    }

    const N: usize = 5;

    fn number(kind: u8, value: f32) -> f32 {
        match kind {
            0 => 0.0,
            1 => -0.0,
            2 => 1e-40 * value,
            3 => value.round(),
            4 => 1e30 * value,
            _ => value,
        }
    }

    proptest! {
        #[test]
        fn rays_are_clipped_in_rows_as_they_are_one_by_one(
            values in prop::collection::vec((0u8..9, -3f32..3.0), 8 * N),
            flat in prop::option::of(0usize..3),
            scale in -20i32..20,
        ) {
            let mut max = Vec3::ONE;
            if let Some(axis) = flat { max[axis] = 0.0; }
            let bounds = Aabb { min: Vec3::ZERO, max: max * 2f32.powi(scale) };
            let grid = Grid::new(bounds, [1; 3]).unwrap();
            let rays: Vec<Ray> = values.chunks_exact(8).map(|v| {
                let at = |i: usize| number(v[i].0, v[i].1);
                let t_max = if v[7].0 < 4 { f32::INFINITY } else { v[7].1 };
                Ray {
                    origin: Vec3::new(at(0), at(1), at(2)) * 2f32.powi(scale),
                    direction: Vec3::new(at(3), at(4), at(5)),
                    t_min: if v[6].0 < 4 { f32::NEG_INFINITY } else { at(6) },
                    t_max,
                }
            }).collect();
            let rows = grid.clip_rows(&RayRows::<N>::load(&rays));
            for (lane, ray) in rays.iter().enumerate().filter(|(_, ray)| ray.validate().is_ok()) {
                let one = grid.clip(ray);
                prop_assert_eq!(one.is_some(), rows.met[lane], "{:?}", ray);
                if let Some(one) = one {
                    let start = [0, 1, 2].map(|axis: usize| rows.start[axis][lane]);
                    let delta = [0, 1, 2].map(|axis: usize| rows.delta[axis][lane]);
                    prop_assert_eq!((one.start.to_array(), one.delta.to_array()), (start, delta));
                    prop_assert_eq!(one.span, rows.span(lane));
                }
            }
        }
    }

    /// Boxes of objects lie at corners of the grid's, on coordinates that are far from 0 or not, and rays from near and far pass
    /// through exactly such a corner.
    #[test]
    fn a_line_that_touches_the_box_of_an_object_touches_the_grid() {
        let mut state = 1u64;
        let mut whole = |most: i32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % (2 * most as u64 + 1)) as f32 - most as f32
        };
        // Miri is a thousand times as slow.
        let rays = if cfg!(miri) { 100 } else { 100_000 };
        let mut touched = 0;
        for i in 0..rays {
            let offset = if i % 2 == 0 { 7_000_000.0 } else { 0.0 };
            let corner = Vec3::splat(offset) + Vec3::new(whole(8), whole(8), whole(8)) * 0.5;
            let size = |of: Vec3| (of.abs() + 1.0) * 0.5;
            let small = size(Vec3::new(whole(6), whole(6), whole(6)));
            let large = small + size(Vec3::new(whole(6), whole(6), whole(6))) - 0.5;
            let object = Aabb { min: corner - small, max: corner };
            let grid = Grid::new(Aabb { min: corner - large, max: corner }, [1; 3]).unwrap();
            let direction = Vec3::new(whole(7), whole(7), whole(7)) * 0.5;
            let origin = corner - direction * (whole(9) * 2f32.powi(i % 20));
            let ray = Ray { origin, direction, t_min: -1e30, t_max: f32::INFINITY };
            if direction != Vec3::ZERO && object.overlap(origin, direction).is_some() {
                touched += 1;
                assert!(grid.clip(&ray).is_some(), "{ray:?} touches {object:?} in {:?}", grid.bounds());
            }
        }
        assert!(touched > rays / 10, "{touched}");
    }

    #[test]
    fn a_box_far_from_the_origin_of_coordinates_is_touched_from_far_away() {
        // Both meet the ray in one point, at t = 2^36, which only one of them is moved to without rounding.
        let ray = Ray::new(
            Vec3::new(34_368_126_976.0, -137_430_564_864.0, 103_087_603_712.0),
            Vec3::new(-0.5, 2.0, -1.5),
        );
        let object = Aabb { min: Vec3::splat(8_388_605.5), max: Vec3::splat(8_388_608.0) };
        assert!(object.overlap(ray.origin, ray.direction).is_some());
        let all = Aabb { max: Vec3::new(8_388_609.0, 8_388_608.0, 8_388_608.0), ..object };
        let grid = Grid::new(all, [4; 3]).unwrap();
        assert!(grid.clip(&ray).is_some());
        assert!(grid.clip_rows(&RayRows::<8>::load(&[ray])).met[0]);
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
