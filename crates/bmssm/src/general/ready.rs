//! Rays made ready to be taken through the levels together.

use super::beam::{Beam, BeamRays};
use super::scratch::{STREAM, Scratch};
use super::state::{DirectionRows, TraversalState};
use accel::grid::{Grid, Span};
use accel::{Nearest, Ray};
use lanes::packet::rows;
use lanes::{Lists, ROW, SHARE, Simd, Task};

/// Octants of directions.
pub(super) const OCTANTS: usize = 8;

/// Prepares rays, and lists those that meet the scene by octant, one by one or in beams. Lists of single rays are
/// as far apart as there is room for all rays, those of beams follow.
pub(super) struct Begin<'a> {
    /// One cell over the scene.
    pub frame: &'a Grid,
    /// How far from each other rays of a beam may begin or end, in unit coordinates.
    pub spread: f32,
    pub rays: &'a [Ray],
    pub scratch: &'a mut Scratch,
}

impl Task for Begin<'_> {
    type Out = Begun;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Begun {
        let Self { frame, spread, rays, scratch } = self;
        assert!(rays.len() <= STREAM, "no more rays than a stream holds");
        let Scratch { states, spans, best, lists, beams, beam_rays, .. } = scratch;
        let all = rays.len().next_multiple_of(SHARE);
        let stride = all + SHARE;
        if states.len() < all {
            states.resize(all, TraversalState::NONE);
            spans.resize(all, Span::default());
            best.resize(all, Nearest::new(0.0));
        }
        if lists.len() < ROW * stride {
            lists.resize(ROW * stride, 0);
        }
        beams.clear();
        beam_rays.clear();
        let mut lens = [0; ROW];
        for (share, rays) in rays.chunks(SHARE).enumerate() {
            let (mut ids, mut marks) = ([0; SHARE], [0; SHARE]);
            for (row, rays) in rays.chunks(ROW).enumerate() {
                let first = share * SHARE + row * ROW;
                let rows = rows(s, rays);
                let segments = frame.clip_rows(&rows);
                let ways = DirectionRows::of(s, &rows, &segments);
                let mut on = 0;
                for lane in 0..rays.len() {
                    // Those that miss the scene are in no list.
                    on |= u32::from(segments.met[lane]) << lane;
                }
                ways.store(s, &segments, &mut states[first..first + ROW]);
                let spans = spans[first..].first_chunk_mut::<ROW>().expect("room for all rays");
                let best = best[first..].first_chunk_mut::<ROW>().expect("room for all rays");
                for lane in 0..ROW {
                    spans[lane] = segments.span(lane);
                    best[lane] = Nearest::new(rows.t_max[lane]);
                }
                if let Some(beam) = Beam::of(s, &segments, &ways, on, first as u32, spread) {
                    beams.push(beam);
                    beam_rays.push(BeamRays::new(rows, on));
                    on = 0;
                }
                for lane in 0..ROW {
                    ids[row * ROW + lane] = (first + lane) as u16;
                    marks[row * ROW + lane] = (on >> lane & 1) as u16 * (1 << ways.octant(lane));
                }
            }
            s.distribute(&ids, &marks, &mut Lists { ids: lists, stride, lens: &mut lens });
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
