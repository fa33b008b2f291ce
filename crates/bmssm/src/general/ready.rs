//! Rays made ready to be taken through the levels together.

use super::General;
use super::beam::{Beam, BeamRays};
use super::traveller::{Traveller, WayRows};
use accel::grid::{RayRows, Span};
use accel::{Nearest, Ray};
use lanes::packet::Packet;
use lanes::{Blocks, PackedObjects, ROW, SHARE, Simd};

/// Rays of a stream at most: as many as short numbers tell apart.
pub(super) const STREAM: usize = 1 << 16;

/// Rays that wait to visit a node or a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    /// As in [`Node::children`].
    pub(super) what: u32,
    /// Where their numbers begin in the lists, and how many they are.
    pub(super) first: u32,
    pub(super) len: u32,
    /// Up to where the lists are in use.
    pub(super) top: u32,
}

/// Pairs of all rays of a packet and all objects of a block, and as many again to be written at once.
pub(super) const PAIRS: usize = (ROW + 1) * lanes::BLOCK;

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
