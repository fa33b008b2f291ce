//! The part of a ray inside a grid, in the grid's finest cells: what [`Grid::clip`] gives, with fewer
//! divisions, and prepared for walking.

use accel::far::Line;
use accel::grid::{Grid, within_reach};
use accel::tolerance::{INSET, LIMIT_S, LIMIT_T, PARALLEL, TOUCH};
use accel::{Aabb, Ray};

/// Maps a scene's coordinates to the cells of a grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    bounds: Aabb,
    /// Cells for each unit of length, or 0 for an axis without extent.
    scale: [f64; 3],
    /// The place of the lower bounds, in cells.
    first: [f64; 3],
    resolution: [u32; 3],
}

/// The points `start + s·delta` with s from 0 to 1, in cells, and where they meet the planes
/// between slices.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClippedSegment {
    start: [f32; 3],
    delta: [f32; 3],
    /// Plane p of an axis is met at s = p·scale + offset.
    scale: [f32; 3],
    offset: [f32; 3],
    /// 1, or −1 in two's complement.
    pub step: [u32; 3],
    forward: [u32; 3],
    t_start: f64,
    /// One over the span of t, infinite if there is none.
    inverse_span: f64,
}

impl Frame {
    pub fn new(lattice: &Grid) -> Self {
        let bounds = lattice.bounds();
        let [low, high] = [bounds.min, bounds.max].map(|v| v.to_array().map(f64::from));
        let resolution = lattice.resolution();
        let inner = resolution.map(|n| f64::from(n) * (1.0 - 2.0 * INSET));
        let of = |a: usize| if high[a] > low[a] { inner[a] / (high[a] - low[a]) } else { 0.0 };
        let first = |a: usize| f64::from(resolution[a]) * if high[a] > low[a] { INSET } else { 0.5 };
        Self {
            bounds: *bounds,
            scale: [of(0), of(1), of(2)],
            first: [first(0), first(1), first(2)],
            resolution,
        }
    }

    #[inline(always)]
    fn clip_line(&self, ray: &Ray, line: &Line) -> Option<ClippedSegment> {
        let direction = ray.direction.to_array().map(f64::from);
        let Line { origin, moved, near, far, .. } = *line;
        let (t_min, t_max) = within_reach(f64::from(ray.t_min), f64::from(ray.t_max));
        let t_start = near.max(t_min - moved);
        let t_end = far.min(t_max - moved);
        // Without end or beginning is only the range of a ray without direction; both would keep the walk from ending.
        let finite = t_start + t_end + direction[0] + direction[1] + direction[2];
        if t_start > t_end + TOUCH * line.scale(t_start, t_end) || !finite.is_finite() {
            return None;
        }
        let span = (t_end - t_start).max(0.0);
        let inverse_span = 1.0 / span;
        let t_begin = moved + t_start;
        let mut way = ClippedSegment { t_start: t_begin, inverse_span, ..ClippedSegment::NOWHERE };
        for a in 0..3 {
            let n = f64::from(self.resolution[a]);
            let place = |t: f64| {
                let cell = (origin[a] + t * direction[a] - f64::from(self.bounds.min[a])) * self.scale[a]
                    + self.first[a];
                cell.clamp(n * INSET, n * (1.0 - INSET))
            };
            let start = place(t_start);
            let delta = place(t_start + span) - start;
            (way.start[a], way.delta[a]) = (start as f32, delta as f32);
            let parallel = delta.abs() < n * PARALLEL;
            let per_cell = 1.0 / delta;
            way.scale[a] = if parallel { 0.0 } else { per_cell as f32 };
            way.offset[a] = if parallel { f32::INFINITY } else { (-start * per_cell) as f32 };
            way.step[a] = if delta < 0.0 { u32::MAX } else { 1 };
            way.forward[a] = u32::from(delta >= 0.0);
        }
        Some(way)
    }

    /// The part of a ray inside the grid and its own range of t, or `None` where there is none.
    #[inline(always)]
    pub fn clip(&self, ray: &Ray) -> Option<ClippedSegment> {
        let corners = [self.bounds.min, self.bounds.max];
        Line::clipped(corners, ray.origin, ray.direction, |line| self.clip_line(ray, line))
    }
}

impl ClippedSegment {
    /// A way of a ray that does not meet the grid.
    pub const NOWHERE: Self = Self {
        start: [0.0; 3],
        delta: [0.0; 3],
        scale: [0.0; 3],
        offset: [f32::INFINITY; 3],
        step: [1; 3],
        forward: [1; 3],
        t_start: 0.0,
        inverse_span: 0.0,
    };

    /// An upper bound of the place s up to which objects must be looked at, when a hit at
    /// `t` is known: what begins behind it can't come before that hit.
    #[inline(always)]
    pub fn limit(&self, t: f32) -> f32 {
        let t = f64::from(t);
        let slack = LIMIT_T * t.abs();
        let s = (t - self.t_start + slack) * self.inverse_span;
        // A way of no length: all of it.
        if s.is_finite() { (s as f32) * (1.0 + 4.0 * f32::EPSILON) + LIMIT_S as f32 } else { 1.0 }
    }

    /// Where the way leaves slices of 2^shift cells.
    #[inline(always)]
    pub fn planes(&self, slice: [u32; 3], shift: u32) -> [f32; 3] {
        let plane = |a: usize| {
            // As signed numbers, which convert in one instruction.
            let plane = (slice[a].wrapping_add(self.forward[a]) << shift).cast_signed();
            plane as f32 * self.scale[a] + self.offset[a]
        };
        [plane(0), plane(1), plane(2)]
    }

    /// The cell at s.
    #[inline(always)]
    pub fn cell(&self, s: f32) -> [u32; 3] {
        let place = |a: usize| (self.start[a] + s * self.delta[a]) as i32;
        [place(0), place(1), place(2)].map(|place| place.max(0).cast_unsigned())
    }

    /// The slices at s of 2^shift cells that lie in `outer`, four times as thick.
    #[inline(always)]
    pub fn cell_within(&self, s: f32, shift: u32, outer: [u32; 3]) -> [u32; 3] {
        let cell = self.cell(s);
        let inner = |a: usize| (cell[a] >> shift).clamp(outer[a] << 2, (outer[a] << 2) + 3);
        [inner(0), inner(1), inner(2)]
    }
}

/// The slices beyond the planes met first, and where those are met. Planes met together are passed
/// together: what lies in the cells between is registered on both sides, being within the grid's margin.
#[inline(always)]
pub(super) fn advance(way: &ClippedSegment, slice: [u32; 3], planes: [f32; 3]) -> ([u32; 3], f32) {
    let exit = planes[0].min(planes[1]).min(planes[2]);
    let next = |a: usize| slice[a].wrapping_add(if planes[a] <= exit { way.step[a] } else { 0 });
    ([next(0), next(1), next(2)], exit)
}
