//! Rays and groups of objects that are to be tested with each other: the boxes of many groups are looked at side by side.

use super::abreast::Lanes;
use super::segment::{ClippedSegment, UnitBox};
use lanes::packet::Overlap;
use lanes::{ROW, Simd};

/// Most pairs that wait.
const MOST: usize = 64;

/// Pairs of rays, by their lanes, and groups.
pub(super) struct Queue {
    lanes: [u8; MOST + ROW],
    groups: [u32; MOST + ROW],
    len: usize,
}

/// What rays are tested with boxes by, coordinate by coordinate.
pub(super) struct UnitRays {
    start: [Lanes<f32>; 3],
    inverse: [Lanes<f32>; 3],
    /// Up to where boxes are looked at.
    limit: Lanes<f32>,
}

impl UnitRays {
    /// No rays.
    pub const NONE: Self =
        Self { start: [[0.0; ROW]; 3], inverse: [[0.0; ROW]; 3], limit: [f32::NEG_INFINITY; ROW] };

    /// Puts a ray into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, segment: &ClippedSegment, limit: f32) {
        for axis in 0..3 {
            self.start[axis][lane] = segment.unit_start[axis];
            self.inverse[axis][lane] = segment.unit_inverse[axis];
        }
        self.limit[lane] = limit;
    }

    /// Lets it look at boxes up to there.
    #[inline(always)]
    pub fn limit(&mut self, lane: usize, limit: f32) {
        self.limit[lane] = limit;
    }
}

impl Queue {
    /// No pairs.
    pub const EMPTY: Self = Self { lanes: [0; MOST + ROW], groups: [0; MOST + ROW], len: 0 };

    /// How many more there is room for.
    #[inline(always)]
    pub fn room(&self) -> usize {
        MOST - self.len
    }

    /// How many wait.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Adds a pair if it is wanted.
    #[inline(always)]
    pub fn add(&mut self, lane: usize, group: u32, wanted: bool) {
        self.lanes[self.len] = lane as u8;
        self.groups[self.len] = group;
        self.len += usize::from(wanted);
    }

    /// Ray and group of a pair.
    #[inline(always)]
    pub fn pair(&self, at: usize) -> (usize, u32) {
        (usize::from(self.lanes[at]) % ROW, self.groups[at])
    }

    /// Takes all off.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Of the 16 pairs from `first` on those whose rays meet the boxes of their groups, as [`ClippedSegment::meets`] has it.
    #[inline(always)]
    pub fn met<S: Simd>(&self, s: S, first: usize, rays: &UnitRays, boxes: &[UnitBox]) -> u32 {
        let mut met = 0;
        let end = self.len.min(first + ROW);
        let all = u32::MAX >> (32 - (end - first));
        for at in (first..end).step_by(S::LANES) {
            let nothing = &boxes[self.groups[first] as usize];
            let (mut lower, mut upper) = ([nothing.lower(); ROW], [nothing.upper(); ROW]);
            for lane in 0..S::LANES.min(end - at) {
                let of = &boxes[self.groups[at + lane] as usize];
                (lower[lane], upper[lane]) = (of.lower(), of.upper());
            }
            let (lower, upper) = (s.load_quads(&lower), s.load_quads(&upper));
            let lanes = &self.lanes[at..];
            let mut overlap = Overlap::up_to(s, each(s, &rays.limit, lanes));
            for axis in 0..3 {
                let (start, inverse) =
                    (each(s, &rays.start[axis], lanes), each(s, &rays.inverse[axis], lanes));
                overlap.cut(s, [lower[axis], upper[axis]], start, inverse);
            }
            met |= s.bits(overlap.lanes(s)) << (at - first);
        }
        met & all
    }
}

/// The values of the rays in these lanes.
#[inline(always)]
fn each<S: Simd>(s: S, values: &Lanes<f32>, lanes: &[u8]) -> S::F {
    if S::LANES == ROW {
        return s.permute(s.load(values), s.load_bytes(lanes));
    }
    let mut chosen = [0.0; ROW];
    for (chosen, lane) in chosen.iter_mut().zip(lanes).take(S::LANES) {
        *chosen = values[usize::from(*lane) % ROW];
    }
    s.load(&chosen)
}
