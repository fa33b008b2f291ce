//! Rays made ready to be taken through the levels together.

use super::beam::{Beam, BeamRays};
use super::scratch::{STREAM, Scratch};
use super::state::{DirectionRows, TraversalState};
use accel::grid::{Grid, Span};
use accel::{Nearest, Ray};
use lanes::packet::{begun_within, rows};
use lanes::{Lists, ROW, SHARE, Simd, Task};

/// The group, after those of octants, of rays of any direction that begin within the scene: what is near comes first for all of
/// them, and together they fill the lists of blocks. What crosses the scene from outside stays with its octant, since what one meets first is last for another.
pub(super) const MIXED: usize = 8;

/// Groups of rays that are listed apart.
const GROUPS: usize = MIXED + 1;

/// Prepares rays, and lists those that meet the scene by group, one by one or in beams.
pub(super) struct Begin<'a> {
    /// One cell over the scene.
    pub frame: &'a Grid,
    /// How far from each other rays of a beam may begin or end, in unit coordinates.
    pub spread: f32,
    /// Whether single rays that begin within the scene are listed together, and not by octant.
    pub mixed: bool,
    pub rays: &'a [Ray],
    pub scratch: &'a mut Scratch,
}

impl Task for Begin<'_> {
    type Out = Begun;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Begun {
        let Self { frame, spread, mixed, rays, scratch } = self;
        assert!(rays.len() <= STREAM, "no more rays than a stream holds");
        let Scratch { states, spans, best, lists, beams, beam_rays, .. } = scratch;
        let all = rays.len().next_multiple_of(SHARE);
        let (count, stride) = (rays.len(), all + SHARE);
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
        let (mut ids, mut marks, mut lens) = ([0; SHARE], [0; SHARE], [0; ROW]);
        for (first, rays) in (0..).step_by(ROW).zip(rays.chunks(ROW)) {
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
            // Neighbours of one octant, such as shadow rays, have a list that fills without others.
            let shared = if mixed && !ways.agree(on) { begun_within(s, &rows, frame.bounds()) } else { 0 };
            if let Some(beam) = Beam::of(s, &segments, &ways, on, first as u32, spread) {
                beams.push(beam);
                beam_rays.push(BeamRays::new(rows, on));
                on = 0;
            }
            let half = first % SHARE;
            for lane in 0..rays.len() {
                let group = if shared >> lane & 1 != 0 { MIXED as u32 } else { ways.octant(lane) };
                ids[half + lane] = (first + lane) as u16;
                marks[half + lane] = (on >> lane & 1) as u16 * (1 << group);
            }
            if half + ROW == SHARE || first + ROW >= count {
                s.distribute(&ids, &marks, &mut Lists { ids: lists, stride, lens: &mut lens });
                marks = [0; SHARE];
            }
        }
        let end = GROUPS * stride;
        let together = listed(beams.iter().map(|beam| beam.octant), end as u32, lists);
        let ready = std::array::from_fn(|group| {
            let (first_beam, beams) = together[group];
            Ready { first: (group * stride) as u32, len: lens[group], first_beam, beams }
        });
        Begun { ready, top: (end + beams.len()).next_multiple_of(SHARE) as u32 }
    }
}

/// Lists numbers from `first` on by group, given the group of each. Answers where each group begins, and how many are in it.
fn listed(
    groups: impl Iterator<Item = usize> + Clone,
    mut first: u32,
    lists: &mut [u16],
) -> [(u32, u32); GROUPS] {
    let mut lens = [0; GROUPS];
    groups.clone().for_each(|group| lens[group] += 1);
    let firsts = lens.map(|len| (first, first += len).0);
    let mut next = firsts;
    for (id, group) in groups.enumerate() {
        lists[next[group] as usize] = id as u16;
        next[group] += 1;
    }
    std::array::from_fn(|group| (firsts[group], lens[group]))
}

/// What is ready to be taken through the levels.
pub(super) struct Begun {
    pub ready: [Ready; GROUPS],
    /// Up to where the lists are in use.
    pub top: u32,
}

/// What is ready of one group.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ready {
    /// Where the list of its single rays begins, and how many there are.
    pub first: u32,
    pub len: u32,
    /// Where the list of its beams begins, and how many there are.
    pub first_beam: u32,
    pub beams: u32,
}
