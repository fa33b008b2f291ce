//! Rays made ready to be taken through the levels together.

use super::General;
use super::beam::{Beam, BeamRays};
use super::stream::{PAIRS, STREAM, Waiting};
use super::trace::LEAST;
use accel::grid::{RayRows, SegmentRows, Span};
use accel::tolerance::LIMIT_S;
use accel::{Nearest, Ray};
use lanes::packet::Packet;
use lanes::{Blocks, PackedObjects, ROW, SHARE, Simd};

/// A ray's way in unit coordinates, as nodes and blocks need it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Traveller {
    /// Where it begins, and the place up to which objects must be looked at; −1 when the ray is done.
    pub start: [f32; 4],
    /// One over each component of the way, and nothing.
    pub inverse: [f32; 4],
}

/// Rays as nodes see them.
pub(super) trait Way {
    /// By which they enter boxes; its limit is theirs.
    fn near(&self) -> &Traveller;
    /// By which they leave boxes.
    fn far(&self) -> &Traveller;
}

impl Way for Traveller {
    #[inline(always)]
    fn near(&self) -> &Traveller {
        self
    }
    #[inline(always)]
    fn far(&self) -> &Traveller {
        self
    }
}

impl Traveller {
    pub const DONE: f32 = -1.0;

    pub const NONE: Self = Self { start: [0.0; 4], inverse: [0.0; 4] };
}

/// What a thread keeps from stream to stream; only the first places, one for each ray of the stream, mean something.
pub(super) struct Room<One> {
    pub(super) travellers: Vec<Traveller>,
    pub(super) spans: Vec<Span>,
    pub(super) ones: Vec<One>,
    pub(super) best: Vec<Nearest>,
    /// Those of neighbours that are taken together.
    pub(super) beams: Vec<Beam>,
    pub(super) beam_rays: Vec<BeamRays>,
    /// Lists of rays, or of beams, by number.
    pub(super) lists: Vec<u16>,
    pub(super) stack: Vec<Waiting>,
    /// Places of rays in a packet, and of candidates in a block.
    pub(super) pair_rays: Vec<u8>,
    pub(super) pair_slots: Vec<u8>,
}

impl<One> Default for Room<One> {
    fn default() -> Self {
        Self {
            travellers: Vec::new(),
            spans: Vec::new(),
            beams: Vec::new(),
            beam_rays: Vec::new(),
            ones: Vec::new(),
            best: Vec::new(),
            lists: Vec::new(),
            stack: Vec::new(),
            pair_rays: vec![0; PAIRS],
            pair_slots: vec![0; PAIRS],
        }
    }
}

/// Octants of directions.
pub(super) const OCTANTS: usize = 8;

impl<O: PackedObjects> General<O> {
    /// Prepares the rays, and lists those that meet the scene by octant, one by one or in beams. Lists of single rays are
    /// `stride` apart, those of beams follow.
    #[inline(always)]
    pub(super) fn begin<S: Simd>(
        &self,
        s: S,
        rays: &[Ray],
        room: &mut Room<<O::Blocks as Blocks>::One>,
    ) -> Begun {
        assert!(rays.len() <= STREAM, "no more rays than a stream holds");
        let Room { travellers, spans, ones, best, lists, beams, beam_rays, .. } = room;
        let all = rays.len().next_multiple_of(SHARE);
        let stride = all + SHARE;
        if travellers.len() < all {
            travellers.resize(all, Traveller::NONE);
            spans.resize(all, Span::default());
            best.resize(all, Nearest::new(0.0));
        }
        if lists.len() < ROW * stride {
            lists.resize(ROW * stride, 0);
        }
        ones.clear();
        beams.clear();
        beam_rays.clear();
        let mut lens = [0; ROW];
        for (share, rays) in rays.chunks(SHARE).enumerate() {
            let (mut ids, mut marks) = ([0; SHARE], [0; SHARE]);
            for (row, rays) in rays.chunks(ROW).enumerate() {
                let first = share * SHARE + row * ROW;
                let rows = rows(s, rays);
                let segments = self.frame.clip_rows(&rows);
                let ways = WayRows::of(s, &rows, &segments);
                let mut on = 0;
                for (lane, ray) in rays.iter().enumerate() {
                    if !O::Blocks::takes_pairs::<S>() {
                        ones.push(self.objects.one(ray));
                    }
                    // Those that miss the scene are in no list.
                    on |= u32::from(segments.met[lane]) << lane;
                }
                ways.store(s, &segments, &mut travellers[first..first + ROW]);
                let spans = spans[first..].first_chunk_mut::<ROW>().expect("room for all rays");
                let best = best[first..].first_chunk_mut::<ROW>().expect("room for all rays");
                for lane in 0..ROW {
                    spans[lane] = segments.span(lane);
                    best[lane] = Nearest::new(rows.t_max[lane]);
                }
                if let Some(beam) = Beam::of(s, &segments, &ways, on, first as u32, self.spread) {
                    beams.push(beam);
                    beam_rays.push(BeamRays::new(rows, on));
                    on = 0;
                }
                for lane in 0..ROW {
                    ids[row * ROW + lane] = (first + lane) as u16;
                    marks[row * ROW + lane] = (on >> lane & 1) as u16 * (1 << ways.octant(lane));
                }
            }
            s.distribute(&ids, &marks, lists, stride, &mut lens);
        }
        let mut octants = [Ready::default(); OCTANTS];
        for (octant, ready) in octants.iter_mut().enumerate() {
            (ready.first, ready.len) = ((octant * stride) as u32, lens[octant]);
        }
        let first = OCTANTS * stride;
        list_beams(beams, first, lists, &mut octants);
        Begun { octants, top: (first + beams.len()).next_multiple_of(SHARE) as u32 }
    }
}

/// Lists beams by octant, from place `first` on.
fn list_beams(beams: &[Beam], first: usize, lists: &mut [u16], octants: &mut [Ready; OCTANTS]) {
    for beam in beams {
        octants[beam.octant].beams += 1;
    }
    let mut first = first as u32;
    for ready in &mut *octants {
        ready.first_beam = first;
        first += ready.beams;
    }
    let mut next = octants.map(|ready| ready.first_beam as usize);
    for (id, beam) in beams.iter().enumerate() {
        lists[next[beam.octant]] = id as u16;
        next[beam.octant] += 1;
    }
}

/// What is ready to be taken through the levels.
pub(super) struct Begun {
    pub octants: [Ready; OCTANTS],
    /// Up to where the lists are in use.
    pub top: u32,
}

/// What is ready of one octant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ready {
    /// Where the list of its single rays begins, and how many there are.
    pub first: u32,
    pub len: u32,
    /// Where the list of its beams begins, and how many there are.
    pub first_beam: u32,
    pub beams: u32,
}

/// The ways of rays beside their segments.
pub(super) struct WayRows {
    pub inverse: [[f32; ROW]; 3],
    /// Which of the rays go backwards on each axis, as bits.
    pub backwards: [u32; 3],
}

impl WayRows {
    #[inline(always)]
    fn of<S: Simd>(s: S, rows: &RayRows<ROW>, segments: &SegmentRows<ROW>) -> Self {
        let mut ways = Self { inverse: [[0.0; ROW]; 3], backwards: [0; 3] };
        let zero = s.splat(0.0);
        for axis in 0..3 {
            for at in (0..ROW).step_by(S::LANES) {
                // Where a component is too small to tell, the direction's sign is as good as any.
                let backwards = s.lt(s.load(&rows.direction[axis][at..]), zero);
                let least = s.select(backwards, s.splat(-LEAST), s.splat(LEAST));
                let delta = s.load(&segments.delta[axis][at..]);
                let long = s.le(s.splat(LEAST), s.abs(delta));
                let delta = s.select(long, delta, least);
                s.store(s.div(s.splat(1.0), delta), &mut ways.inverse[axis][at..]);
                ways.backwards[axis] |= s.bits(backwards) << at;
            }
        }
        ways
    }

    #[inline(always)]
    fn octant(&self, lane: usize) -> u32 {
        let [x, y, z] = self.backwards;
        (x >> lane & 1) | (y >> lane & 1) << 1 | (z >> lane & 1) << 2
    }

    #[inline(always)]
    fn store<S: Simd>(&self, s: S, segments: &SegmentRows<ROW>, to: &mut [Traveller]) {
        let limit = s.splat(LIMIT);
        for at in (0..ROW).step_by(S::LANES) {
            let (mut start, mut inverse) = ([limit; 4], [limit; 4]);
            for axis in 0..3 {
                inverse[axis] = s.load(&self.inverse[axis][at..]);
                start[axis] = s.load(&segments.start[axis][at..]);
            }
            let (start, inverse) = (s.store_quads(start), s.store_quads(inverse));
            for (to, (start, inverse)) in to[at..at + S::LANES].iter_mut().zip(start.iter().zip(&inverse)) {
                *to = Traveller { start: *start, inverse: *inverse };
            }
        }
    }
}

/// The place up to which objects must be looked at while nothing is hit.
pub(super) const LIMIT: f32 = 1.0 + LIMIT_S as f32;

/// Up to 16 rays coordinate by coordinate; where there are fewer, the first stands in for the others.
#[inline(always)]
pub(super) fn rows<S: Simd>(s: S, rays: &[Ray]) -> RayRows<ROW> {
    let mut chosen = [&rays[0]; ROW];
    for (chosen, ray) in chosen.iter_mut().zip(rays) {
        *chosen = ray;
    }
    let zero = [0.0; ROW];
    let mut rows = RayRows { origin: [zero; 3], direction: [zero; 3], t_min: zero, t_max: zero };
    for at in (0..ROW).step_by(S::LANES) {
        let mut here = chosen;
        here[..S::LANES].copy_from_slice(&chosen[at..at + S::LANES]);
        let packet = Packet::gather(s, &here);
        for axis in 0..3 {
            s.store(packet.origin[axis], &mut rows.origin[axis][at..]);
            s.store(packet.direction[axis], &mut rows.direction[axis][at..]);
        }
        s.store(packet.t_min, &mut rows.t_min[at..]);
        s.store(packet.t_max, &mut rows.t_max[at..]);
    }
    rows
}
