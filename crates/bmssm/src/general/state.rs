//! Rays on their way through the scene.

use accel::grid::{RayRows, SegmentRows};
use accel::tolerance::{LIMIT_S, PARALLEL};
use lanes::{ROW, Simd};

/// A component of the way is at least this long, so that its reciprocal is finite and no product is NaN.
pub(super) const MIN: f32 = PARALLEL as f32;

/// A ray on its way, in unit coordinates, as nodes and blocks need it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct TraversalState {
    /// Where it begins, and the place up to which objects must be looked at; −1 when the ray is done.
    pub start: [f32; 4],
    /// One over each component of the way, and nothing.
    pub inverse: [f32; 4],
}

/// Rays as nodes see them.
pub(super) trait NodeView {
    /// By which they enter boxes; its limit is theirs.
    fn near(&self) -> &TraversalState;
    /// By which they leave boxes.
    fn far(&self) -> &TraversalState;
}

impl NodeView for TraversalState {
    #[inline(always)]
    fn near(&self) -> &TraversalState {
        self
    }
    #[inline(always)]
    fn far(&self) -> &TraversalState {
        self
    }
}

impl TraversalState {
    pub const DONE: f32 = -1.0;

    pub const NONE: Self = Self { start: [0.0; 4], inverse: [0.0; 4] };
}

/// What rows of segments have besides: directions as nodes need them.
pub(super) struct DirectionRows {
    pub inverse: [[f32; ROW]; 3],
    /// Which of the rays go backwards on each axis, as bits.
    pub backwards: [u32; 3],
}

impl DirectionRows {
    #[inline(always)]
    pub fn of<S: Simd>(s: S, rows: &RayRows<ROW>, segments: &SegmentRows<ROW>) -> Self {
        let mut ways = Self { inverse: [[0.0; ROW]; 3], backwards: [0; 3] };
        let zero = s.splat(0.0);
        for axis in 0..3 {
            for at in (0..ROW).step_by(S::LANES) {
                // Where a component is too small to tell, the direction's sign is as good as any.
                let backwards = s.lt(s.load(&rows.direction[axis][at..]), zero);
                let least = s.select(backwards, s.splat(-MIN), s.splat(MIN));
                let delta = s.load(&segments.delta[axis][at..]);
                let long = s.le(s.splat(MIN), s.abs(delta));
                let delta = s.select(long, delta, least);
                s.store(s.div(s.splat(1.0), delta), &mut ways.inverse[axis][at..]);
                ways.backwards[axis] |= s.bits(backwards) << at;
            }
        }
        ways
    }

    /// Whether the rays `on` are of one octant.
    #[inline(always)]
    pub fn agree(&self, on: u32) -> bool {
        self.backwards.iter().all(|backwards| backwards & on == 0 || backwards & on == on)
    }

    #[inline(always)]
    pub fn octant(&self, lane: usize) -> u32 {
        let [x, y, z] = self.backwards;
        (x >> lane & 1) | (y >> lane & 1) << 1 | (z >> lane & 1) << 2
    }

    #[inline(always)]
    pub fn store<S: Simd>(&self, s: S, segments: &SegmentRows<ROW>, to: &mut [TraversalState]) {
        let limit = s.splat(LIMIT);
        for at in (0..ROW).step_by(S::LANES) {
            let (mut start, mut inverse) = ([limit; 4], [limit; 4]);
            for axis in 0..3 {
                inverse[axis] = s.load(&self.inverse[axis][at..]);
                start[axis] = s.load(&segments.start[axis][at..]);
            }
            let (start, inverse) = (s.store_quads(start), s.store_quads(inverse));
            for (to, (start, inverse)) in to[at..at + S::LANES].iter_mut().zip(start.iter().zip(&inverse)) {
                *to = TraversalState { start: *start, inverse: *inverse };
            }
        }
    }
}

/// The place up to which objects must be looked at while nothing is hit.
pub(super) const LIMIT: f32 = 1.0 + LIMIT_S as f32;
