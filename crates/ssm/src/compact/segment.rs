//! The part of a ray inside a grid, in the grid's finest cells, prepared for walking and for boxes.

use super::brick::{EDGE, SHIFT};
use accel::grid::{Grid, RayRows, Span};
use accel::tolerance::{INSET, LIMIT_S, PARALLEL};
use accel::{Aabb, Ray};
use lanes::packet::{Overlap, Vec3Lanes};
use lanes::{ROW, Scalar, Simd};

/// Maps the unit coordinates of a grid to its cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    finest: Grid,
    /// Cells for each unit, or 0 for an axis without extent.
    scale: [f32; 3],
    /// The place of the lower bounds, in cells.
    first: [f32; 3],
    /// A segment that moves fewer cells than this along an axis counts as parallel to its slices.
    parallel: [f32; 3],
}

/// The points `start + s·delta` with s from 0 to 1, in cells, and where they meet the planes
/// between slices.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClippedSegment {
    pub start: [f32; 3],
    pub delta: [f32; 3],
    /// Plane p of an axis is met at s = p·scale + offset.
    pub scale: [f32; 3],
    pub offset: [f32; 3],
    /// 1, or −1 in two's complement.
    pub step: [u32; 3],
    pub forward: [u32; 3],
    /// Where it starts in the grid's unit coordinates.
    pub unit_start: [f32; 3],
    /// One over its length in unit coordinates, finite.
    pub unit_inverse: [f32; 3],
    /// The sides by which it enters boxes.
    near: [u32; 3],
    span: Span,
}

/// A box in a grid's unit coordinates, widened by the grid's margin: three lower bounds, and from [`UPPER`] on three upper
/// ones.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct UnitBox([f32; 8]);

/// Where upper bounds begin.
const UPPER: usize = 4;

impl UnitBox {
    /// The lower bounds, and a number without meaning.
    #[inline(always)]
    pub fn lower(&self) -> &[f32; UPPER] {
        let (lower, _) = self.0.split_first_chunk().unwrap_or((&[0.0; UPPER], &[]));
        lower
    }

    /// The upper bounds, likewise.
    #[inline(always)]
    pub fn upper(&self) -> &[f32; UPPER] {
        let (_, upper) = self.0.split_last_chunk().unwrap_or((&[], &[0.0; UPPER]));
        upper
    }

    /// About what part of the lines through a cell of a grid meet this box too: that of the cell's sides, seen along each axis,
    /// which it covers.
    pub fn part_of_cell(&self, slices: [u32; 3], resolution: [u32; 3]) -> f64 {
        let Self(sides) = self;
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let n = resolution[axis] as f32;
            let inside = |side: f32| (side * n - slices[axis] as f32).clamp(0.0, 1.0);
            f64::from(inside(sides[UPPER + axis]) - inside(sides[axis]))
        });
        (x * y + y * z + z * x) / 3.0
    }
}

impl Frame {
    pub fn new(finest: &Grid) -> Self {
        Self::with_inset(finest, INSET)
    }

    fn with_inset(finest: &Grid, inset: f64) -> Self {
        let extent = finest.bounds().max.as_dvec3() - finest.bounds().min.as_dvec3();
        let (mut scale, mut first, mut parallel) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (a, n) in finest.resolution().into_iter().enumerate() {
            let (n, flat) = (f64::from(n), extent[a] <= 0.0);
            scale[a] = if flat { 0.0 } else { (n * (1.0 - 2.0 * inset)) as f32 };
            first[a] = (n * if flat { 0.5 } else { inset }) as f32;
            parallel[a] = (n * PARALLEL) as f32;
        }
        Self { finest: *finest, scale, first, parallel }
    }

    /// A box in unit coordinates.
    pub fn unit_box(&self, bounds: &Aabb) -> UnitBox {
        let margin = accel::grid::MARGIN as f32;
        let unit = |axis: usize, value: f32| self.finest.unit(axis, f64::from(value)) as f32;
        let low = [0, 1, 2].map(|axis| unit(axis, bounds.min[axis]) - margin);
        let high = [0, 1, 2].map(|axis| unit(axis, bounds.max[axis]) + margin);
        UnitBox([low[0], low[1], low[2], 0.0, high[0], high[1], high[2], 0.0])
    }

    /// The part of a ray inside the grid and its own range of t, if there is one: that of lane 0.
    #[inline(always)]
    pub fn clip(&self, ray: &Ray) -> SegmentRows {
        let mut rows = SegmentRows::NONE;
        if let Some(segment) = self.finest.clip(ray) {
            let (start, delta) = (segment.start.to_array(), segment.delta.to_array());
            self.prepare(Scalar, start, delta, &mut rows, 0);
            (rows.met[0], rows.spans[0]) = (true, segment.span());
        }
        rows
    }

    /// The same of each of several rays.
    #[inline(always)]
    pub fn clip_rows<S: Simd>(&self, s: S, rays: &RayRows<ROW>) -> SegmentRows {
        let segments = self.finest.clip_rows(rays);
        let mut rows = SegmentRows { met: segments.met, ..SegmentRows::NONE };
        for at in (0..ROW).step_by(S::LANES) {
            let (mut start, mut delta) = ([s.splat(0.0); 3], [s.splat(0.0); 3]);
            for axis in 0..3 {
                start[axis] = s.load(&segments.start[axis][at..]);
                delta[axis] = s.load(&segments.delta[axis][at..]);
            }
            self.prepare(s, start, delta, &mut rows, at);
        }
        for (lane, span) in rows.spans.iter_mut().enumerate() {
            *span = segments.span(lane);
        }
        rows
    }

    /// Writes what follows from start and delta in unit coordinates from lane `at` on.
    #[inline(always)]
    fn prepare<S: Simd>(
        &self,
        s: S,
        unit_start: Vec3Lanes<S>,
        unit_delta: Vec3Lanes<S>,
        rows: &mut SegmentRows,
        at: usize,
    ) {
        let (zero, one, least) = (s.splat(0.0), s.splat(1.0), s.splat(PARALLEL as f32));
        for axis in 0..3 {
            let scale = s.splat(self.scale[axis]);
            let start = s.add(s.mul(unit_start[axis], scale), s.splat(self.first[axis]));
            let delta = s.mul(unit_delta[axis], scale);
            // NaN, of rays without a direction, moves nowhere: walks end for every plane lies at infinity.
            let moves = s.le(s.splat(self.parallel[axis]), s.abs(delta));
            let per_cell = s.div(one, delta);
            let offset = s.sub(zero, s.mul(start, per_cell));
            s.store(start, &mut rows.start[axis][at..]);
            s.store(delta, &mut rows.delta[axis][at..]);
            s.store(s.select(moves, per_cell, zero), &mut rows.scale[axis][at..]);
            s.store(s.select(moves, offset, s.splat(f32::INFINITY)), &mut rows.offset[axis][at..]);
            let shortest = s.select(s.le(zero, unit_delta[axis]), least, s.sub(zero, least));
            let long = s.le(least, s.abs(unit_delta[axis]));
            let inverse = s.div(one, s.select(long, unit_delta[axis], shortest));
            s.store(unit_start[axis], &mut rows.unit_start[axis][at..]);
            s.store(inverse, &mut rows.unit_inverse[axis][at..]);
        }
    }
}

/// The segments of several rays, coordinate by coordinate, with the fields of [`ClippedSegment`].
pub(super) struct SegmentRows {
    met: [bool; ROW],
    pub start: [[f32; ROW]; 3],
    pub delta: [[f32; ROW]; 3],
    scale: [[f32; ROW]; 3],
    offset: [[f32; ROW]; 3],
    unit_start: [[f32; ROW]; 3],
    unit_inverse: [[f32; ROW]; 3],
    spans: [Span; ROW],
}

impl SegmentRows {
    pub const NONE: Self = {
        let zero = [[0.0; ROW]; 3];
        Self {
            met: [false; ROW],
            start: zero,
            delta: zero,
            scale: zero,
            offset: zero,
            unit_start: zero,
            unit_inverse: zero,
            spans: [Span::NONE; ROW],
        }
    };

    /// Of these lanes those whose rays meet the grid.
    #[inline(always)]
    pub fn meeting(&self, lanes: u32) -> u32 {
        self.met.iter().zip(0..).fold(0, |bits, (met, lane)| bits | u32::from(*met) << lane) & lanes
    }

    /// The lanes whose rays meet a box anywhere.
    #[inline(always)]
    pub fn meets<S: Simd>(&self, s: S, UnitBox(sides): &UnitBox) -> u32 {
        let mut met = 0;
        for at in (0..ROW).step_by(S::LANES) {
            let mut overlap = Overlap::up_to(s, s.splat(ClippedSegment::LIMIT));
            for axis in 0..3 {
                let start = s.load(&self.unit_start[axis][at..]);
                let inverse = s.load(&self.unit_inverse[axis][at..]);
                overlap.cut(s, [s.splat(sides[axis]), s.splat(sides[axis + UPPER])], start, inverse);
            }
            met |= s.bits(overlap.lanes(s)) << at;
        }
        met
    }

    /// That of one ray, if it meets the grid.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Option<ClippedSegment> {
        if !self.met[lane] {
            return None;
        }
        let mut segment = ClippedSegment { span: self.spans[lane], ..ClippedSegment::NOWHERE };
        for axis in 0..3 {
            segment.start[axis] = self.start[axis][lane];
            segment.delta[axis] = self.delta[axis][lane];
            segment.scale[axis] = self.scale[axis][lane];
            segment.offset[axis] = self.offset[axis][lane];
            segment.unit_start[axis] = self.unit_start[axis][lane];
            segment.unit_inverse[axis] = self.unit_inverse[axis][lane];
            let backward = segment.delta[axis] < 0.0;
            segment.step[axis] = if backward { u32::MAX } else { 1 };
            segment.forward[axis] = u32::from(!backward);
            segment.near[axis] = axis as u32 + if backward { UPPER as u32 } else { 0 };
        }
        Some(segment)
    }
}

impl ClippedSegment {
    /// A segment of a ray that does not meet the grid.
    pub const NOWHERE: Self = Self {
        start: [0.0; 3],
        delta: [0.0; 3],
        scale: [0.0; 3],
        offset: [f32::INFINITY; 3],
        step: [1; 3],
        forward: [1; 3],
        unit_start: [0.0; 3],
        unit_inverse: [0.0; 3],
        near: [0; 3],
        span: Span::NONE,
    };

    /// What [`ClippedSegment::limit`] is for boxes while nothing is hit.
    pub const LIMIT: f32 = 1.0 + LIMIT_S as f32;

    /// See [`Span::limit`].
    #[inline(always)]
    pub fn limit(&self, t: f32) -> f32 {
        self.span.limit(t)
    }

    /// Whether it meets a box at an s up to `limit`.
    #[inline(always)]
    pub fn meets(&self, UnitBox(sides): &UnitBox, limit: f32) -> bool {
        let (mut enter, mut exit) = (0.0, limit);
        for axis in 0..3 {
            let side = self.near[axis] as usize % 8;
            let near = (sides[side] - self.unit_start[axis]) * self.unit_inverse[axis];
            let far = (sides[side ^ UPPER] - self.unit_start[axis]) * self.unit_inverse[axis];
            enter = greater(near, enter);
            exit = lesser(far, exit);
        }
        enter <= exit
    }

    /// Steps from there on, in slices of 2^shift cells.
    #[inline(always)]
    pub fn from(&self, slice: [u32; 3], shift: u32) -> Steps {
        let mut steps = Steps { slice, planes: [0.0; 3], between: [0.0; 3], step: self.step };
        for (a, slice) in slice.into_iter().enumerate() {
            [steps.planes[a], steps.between[a]] =
                planes(slice.wrapping_add(self.forward[a]), shift, self.scale[a], self.offset[a]);
        }
        steps
    }

    /// The cell at s.
    #[inline(always)]
    pub fn cell(&self, s: f32) -> [u32; 3] {
        let cell = |a: usize| cell_at(self.start[a] + s * self.delta[a]);
        [cell(0), cell(1), cell(2)]
    }

    /// The slices at s of 2^shift cells that lie in `outer`, four times as thick.
    #[inline(always)]
    pub fn cell_within(&self, s: f32, shift: u32, outer: [u32; 3]) -> [u32; 3] {
        let cell = self.cell(s);
        let inner = |a: usize| slice_within(cell[a], shift, outer[a]);
        [inner(0), inner(1), inner(2)]
    }
}

/// The cell at a place on an axis; what is before the first counts to it.
#[inline(always)]
pub(super) fn cell_at(place: f32) -> u32 {
    (place as i32).max(0).cast_unsigned()
}

/// Of the slices of 2^shift cells in `outer`, four times as thick, the one that a cell lies in or is nearest to.
#[inline(always)]
pub(super) fn slice_within(cell: u32, shift: u32, outer: u32) -> u32 {
    let first = outer << SHIFT;
    (cell >> shift).max(first).min(first | (EDGE - 1))
}

/// Where a segment meets a plane of an axis, and how far it is from there to the next plane, planes being 2^shift cells apart;
/// `scale` and `offset` are those of [`ClippedSegment`].
#[inline(always)]
pub(super) fn planes(plane: u32, shift: u32, scale: f32, offset: f32) -> [f32; 2] {
    // As signed numbers, which convert in one instruction.
    let place = (plane << shift).cast_signed() as f32;
    let thickness = (1u32 << shift).cast_signed() as f32;
    [place * scale + offset, (scale * thickness).abs()]
}

/// Steps from slice to slice, of one thickness. Each step adds its rounding: no more than four in a row along an axis.
#[derive(Clone, Copy)]
pub(super) struct Steps {
    /// Where it is.
    pub slice: [u32; 3],
    /// Where it leaves that on each axis.
    planes: [f32; 3],
    /// From one plane to the next.
    between: [f32; 3],
    step: [u32; 3],
}

impl Steps {
    /// Goes to the slices beyond the planes that are met first, and tells where those are met. Planes met together are passed
    /// together: what lies in the cells between is registered on both sides, being within the grid's margin.
    #[inline(always)]
    pub fn advance(&mut self) -> f32 {
        let planes = self.planes;
        let exit = lesser(lesser(planes[0], planes[1]), planes[2]);
        for (a, plane) in planes.into_iter().enumerate() {
            let passed = plane <= exit;
            self.slice[a] = self.slice[a].wrapping_add(if passed { self.step[a] } else { 0 });
            self.planes[a] = plane + if passed { self.between[a] } else { 0.0 };
        }
        exit
    }
}

// As comparisons, for `f32::min` and `f32::max` treat NaN, of which there is none, at the cost of more instructions.

#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;
    use lanes::packet::rows;
    use lanes::{Portable, Task};

    /// The segment of each ray, clipped with others and alone.
    struct Both<'a>(&'a Frame, &'a [Ray]);

    impl Task for Both<'_> {
        type Out = Vec<[Option<ClippedSegment>; 2]>;
        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> Self::Out {
            let Self(frame, rays) = self;
            let all = frame.clip_rows(s, &rows(s, rays));
            let each = rays.iter().enumerate();
            each.map(|(lane, ray)| [all.lane(lane), frame.clip(ray).lane(0)]).collect()
        }
    }

    /// Ends of rays through a grid of small and large resolutions that lie in no cell, where the grid is shrunk by `inset`.
    fn outside(inset: f64) -> usize {
        let mut state = 1u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        let mut outside = 0;
        for resolution in [[1, 3, 7], [64, 100, 1000], [4096, 2048, 5000]] {
            let bounds = Aabb { min: Vec3::new(-1.0, 2.0, 0.3), max: Vec3::new(3.0, 5.0, 0.7) };
            let frame = Frame::with_inset(&Grid::new(bounds, resolution).unwrap(), inset);
            for _ in 0..20_000 {
                let [from, to] = [0, 1].map(|_| Vec3::new(number(), number(), number()) * 8.0 - 2.0);
                let Some(segment) = frame.clip(&Ray::new(from, to - from)).lane(0) else { continue };
                let lies_outside = |s: f32| (0..3).any(|axis| segment.cell(s)[axis] >= resolution[axis]);
                outside += usize::from(lies_outside(0.0)) + usize::from(lies_outside(1.0));
            }
        }
        outside
    }

    #[test]
    fn an_inset_too_small_leaves_ends_of_rays_without_a_cell() {
        assert_eq!(outside(INSET), 0);
        assert!(outside(0.0) > 1000, "{}", outside(0.0));
        assert!(outside(INSET / 256.0) > 0);
    }

    #[test]
    fn segments_are_the_same_alone_and_among_others() {
        let bounds = Aabb { min: Vec3::new(-1.0, 2.0, 0.0), max: Vec3::new(3.0, 5.0, 0.0) };
        let frame = Frame::new(&Grid::new(bounds, [16, 4, 4]).unwrap());
        let rays: Vec<Ray> = (0..ROW)
            .map(|i| {
                let i = i as f32;
                Ray::new(
                    Vec3::new(i * 0.3 - 2.0, 3.0, 1.0 - i * 0.25),
                    Vec3::new(i - 7.0, 0.0, i * 0.5 - 4.0),
                )
            })
            .collect();
        let segments = Both(&frame, &rays).run(Portable);
        assert!(
            segments.iter().any(|[all, _]| all.is_some()) && segments.iter().any(|[all, _]| all.is_none())
        );
        for [all, alone] in segments {
            assert_eq!(format!("{all:?}"), format!("{alone:?}"));
        }
    }

    #[test]
    fn what_has_no_direction_meets_no_plane() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::splat(8.0) };
        let frame = Frame::new(&Grid::new(bounds, [8; 3]).unwrap());
        for direction in [Vec3::ZERO, Vec3::INFINITY, Vec3::new(f32::INFINITY, 1.0, 0.0)] {
            let ray = Ray { t_max: 7.0, ..Ray::new(Vec3::splat(0.5), direction) };
            let Some(segment) = frame.clip(&ray).lane(0) else { continue };
            let mut steps = segment.from(segment.cell(0.0), 0);
            assert!((0..8 * 3).any(|_| steps.advance() > 1.0), "{segment:?}");
        }
    }

    #[test]
    fn boxes_are_met_up_to_the_limit() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::splat(8.0) };
        let frame = Frame::new(&Grid::new(bounds, [8; 3]).unwrap());
        let at =
            |x: f32| frame.unit_box(&Aabb { min: Vec3::new(x, 3.0, 3.0), max: Vec3::new(x + 1.0, 4.0, 4.0) });
        for (from, direction) in [(-1.0, Vec3::X), (9.0, -Vec3::X), (-1.0, Vec3::new(1.0, 1e-30, -1e-30))] {
            let segment = frame.clip(&Ray::new(Vec3::new(from, 3.5, 4.0), direction)).lane(0).unwrap();
            assert!(segment.meets(&at(4.0), 1.0) && !segment.meets(&at(4.0), 0.25));
            let beside = Aabb { min: Vec3::new(4.0, 4.5, 3.0), max: Vec3::new(5.0, 5.0, 5.0) };
            assert!(!segment.meets(&frame.unit_box(&beside), 1.0));
        }
    }
}
