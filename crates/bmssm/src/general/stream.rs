//! Many rays through the levels together: each node sorts the rays that reach it to its children, so that its boxes are
//! read once for all of them and no ray waits for itself (R. Barringer, T. Akenine-Möller, *Dynamic Ray Stream Traversal*, ACM
//! Transactions on Graphics 33(4), 2014).

use super::General;
use super::maps::BlockMaps;
use super::trace::at_least;
use super::tree::{Node, WIDTH};
use accel::grid::{RayRows, SegmentRows, Span};
use accel::{Count, Nearest, Ray};
use lanes::packet::{Packet, Pairs};
use lanes::path::Path;
use lanes::{Blocks, PackedObjects, ROW, SHARE, Simd, prefetch};

/// Rays of a stream at most: what they need fits into a cache of the second level.
pub(super) const STREAM: usize = 1 << 13;

/// A ray on its way, as its tests need it: four values each that are loaded at once.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
struct Traveller {
    /// In unit coordinates, and the place up to which objects must be looked at; −1 when the ray is done.
    start: [f32; 4],
    /// One over each component of the way, and nothing.
    inverse: [f32; 4],
    /// The way, and nothing.
    delta: [f32; 4],
    /// The ray's own, and `t_min`.
    origin: [f32; 4],
    /// The ray's own, and `t_max`.
    direction: [f32; 4],
}

impl Traveller {
    const DONE: f32 = -1.0;
}

/// The ways of rays through the scene, coordinate by coordinate.
struct Ways {
    start: [[f32; ROW]; 3],
    delta: [[f32; ROW]; 3],
    inverse: [[f32; ROW]; 3],
    /// Which components of each way are negative, as bits.
    octant: [u8; ROW],
}

impl Ways {
    #[inline(always)]
    fn of(rows: &SegmentRows<ROW>) -> Self {
        let (mut delta, mut inverse, mut octant) = (rows.delta, [[0.0; ROW]; 3], [0; ROW]);
        for axis in 0..3 {
            for lane in 0..ROW {
                let component = at_least(delta[axis][lane]);
                delta[axis][lane] = component;
                inverse[axis][lane] = 1.0 / component;
                octant[lane] |= u8::from(component < 0.0) << axis;
            }
        }
        Self { start: rows.start, delta, inverse, octant }
    }

    #[inline(always)]
    fn traveller(&self, lane: usize, ray: &Ray, limit: f32) -> Traveller {
        let Self { start, delta, inverse, .. } = self;
        Traveller {
            start: [start[0][lane], start[1][lane], start[2][lane], limit],
            inverse: [inverse[0][lane], inverse[1][lane], inverse[2][lane], 0.0],
            delta: [delta[0][lane], delta[1][lane], delta[2][lane], 0.0],
            origin: [ray.origin.x, ray.origin.y, ray.origin.z, ray.t_min],
            direction: [ray.direction.x, ray.direction.y, ray.direction.z, ray.t_max],
        }
    }
}

/// Rays that wait to visit a node or a block.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    /// As in [`Node::children`].
    what: u32,
    /// Where their numbers begin in the lists, and how many they are.
    first: u32,
    len: u32,
    /// Up to where the lists are in use.
    top: u32,
}

/// What a thread keeps from stream to stream.
pub(super) struct Room<One> {
    travellers: Vec<Traveller>,
    spans: Vec<Span>,
    ones: Vec<One>,
    pub(super) best: Vec<Nearest>,
    /// Numbers of rays, list after list.
    lists: Vec<u16>,
    stack: Vec<Waiting>,
    /// Places of rays in a packet, and of candidates in a block.
    pair_rays: Vec<u8>,
    pair_slots: Vec<u8>,
}

impl<One> Default for Room<One> {
    fn default() -> Self {
        Self {
            travellers: Vec::new(),
            spans: Vec::new(),
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
const OCTANTS: usize = 8;

impl<O: PackedObjects> General<O> {
    /// The nearest hits of up to [`STREAM`] rays, or for `ANY` some hit, left in `room.best`.
    #[inline(always)]
    pub(super) fn stream<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        rays: &[Ray],
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        let octants = self.begin::<S>(rays, room);
        if self.nodes.is_empty() {
            return;
        }
        let mut first = 0;
        for (octant, len) in octants.into_iter().enumerate().take(OCTANTS) {
            if len > 0 {
                let top = rays.len() as u32;
                room.stack.push(Waiting { what: 0, first, len, top });
                self.drain::<S, C, ANY>(s, octant, room, count);
            }
            first += len;
        }
        if !O::Blocks::takes_pairs::<S>() {
            for (one, best) in room.ones.iter().zip(&mut room.best) {
                self.objects.resolve(one, best);
            }
        }
    }

    /// Prepares the rays and lists those that meet the scene by octant; tells how many are in each.
    #[inline(always)]
    fn begin<S: Simd>(
        &self,
        rays: &[Ray],
        room: &mut Room<<O::Blocks as Blocks>::One>,
    ) -> [u32; OCTANTS + 1] {
        assert!(rays.len() <= STREAM, "no more rays than a stream holds");
        let Room { travellers, spans, ones, best, lists, .. } = room;
        travellers.clear();
        spans.clear();
        ones.clear();
        best.clear();
        if lists.len() < rays.len() + SHARE {
            lists.resize(rays.len() + SHARE, 0);
        }
        let mut places = [0; STREAM];
        let mut counts = [0; OCTANTS + 1];
        let limit = 1.0 + accel::tolerance::LIMIT_S as f32;
        for (rays, places) in rays.chunks(ROW).zip(places.chunks_exact_mut(ROW)) {
            let rows = self.frame.clip_rows(&RayRows::load(rays));
            let ways = Ways::of(&rows);
            for (lane, (ray, place)) in rays.iter().zip(places).enumerate() {
                best.push(Nearest::new(ray.t_max));
                spans.push(rows.span(lane));
                travellers.push(ways.traveller(lane, ray, limit));
                if !O::Blocks::takes_pairs::<S>() {
                    ones.push(self.objects.one(ray));
                }
                // Those that miss the scene are in none.
                let octant = if rows.met[lane] { ways.octant[lane] } else { OCTANTS as u8 };
                counts[usize::from(octant)] += 1;
                *place = octant;
            }
        }
        let mut next = [0; OCTANTS + 1];
        for octant in 0..OCTANTS {
            next[octant + 1] = next[octant] + counts[octant];
        }
        for (i, place) in places[..rays.len()].iter().enumerate() {
            let next = &mut next[usize::from(*place)];
            lists[*next as usize] = i as u16;
            *next += 1;
        }
        counts
    }

    /// Takes rays of one octant through all that they meet.
    #[inline(always)]
    fn drain<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        octant: usize,
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        let negative = [octant & 1 != 0, octant & 2 != 0, octant & 4 != 0];
        while let Some(next) = room.stack.pop() {
            if next.what & Node::BLOCK == 0 {
                count.cells(u64::from(next.len));
                visit(s, &self.nodes[next.what as usize], &negative, next, room);
                for waiting in room.stack.iter().rev().take(2) {
                    self.ask_for(waiting.what);
                }
            } else {
                count.blocks(u64::from(next.len));
                self.block::<S, C, ANY>(s, &negative, next, room, count);
            }
        }
    }

    #[inline(always)]
    fn ask_for(&self, what: u32) {
        if what & Node::BLOCK == 0 {
            prefetch(&self.nodes[what as usize]);
        } else {
            prefetch(&self.maps[(what & !Node::BLOCK) as usize]);
        }
    }

    /// Tests rays with the objects of a block.
    #[inline(always)]
    fn block<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        negative: &[bool; 3],
        at: Waiting,
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        let block = (at.what & !Node::BLOCK) as usize;
        let maps = &self.maps[block];
        let Room { travellers, spans, ones, best, lists, pair_rays, pair_slots, .. } = room;
        let list = &lists[at.first as usize..(at.first + at.len) as usize];
        for ids in list.chunks(S::LANES) {
            let mut chosen = [&travellers[usize::from(ids[0]) % travellers.len()]; ROW];
            for (chosen, id) in chosen.iter_mut().zip(ids) {
                *chosen = &travellers[usize::from(*id)];
            }
            let paths = Paths::of(s, maps, negative, &chosen, ids.len());
            let mut pairs = 0;
            let (mut limits, mut changed) = ([Traveller::DONE; ROW], 0u32);
            let mut met = paths.met;
            while met != 0 {
                let lane = met.trailing_zeros() as usize % ROW;
                met &= met - 1;
                let candidates = maps.along(s, paths.axes[lane] as usize, &paths.path(lane));
                count.candidates(u64::from(candidates.count_ones()));
                count.tests(u64::from(candidates.count_ones()));
                if O::Blocks::takes_pairs::<S>() {
                    let slots = pair_slots[pairs..].first_chunk_mut().expect("room for all pairs");
                    pair_rays[pairs..pairs + 64].fill(lane as u8);
                    pairs += s.set_bits(candidates, slots);
                } else if candidates != 0 {
                    let id = usize::from(ids[lane]);
                    let (best, span) = (&mut best[id], &spans[id]);
                    if ANY {
                        if self.objects.any(s, block, candidates, &ones[id], best.t) {
                            *best = Nearest { t: best.t, object: 0, u: 0.0, v: 0.0 };
                            changed |= 1 << lane;
                        }
                    } else {
                        let before = best.t;
                        self.objects.closest(s, block, candidates, &ones[id], best);
                        if best.t < before {
                            (limits[lane], changed) = (span.limit(best.t), changed | 1 << lane);
                        }
                    }
                }
            }
            if pairs > 0 {
                let mut quads = [&chosen[0].origin; ROW];
                for (quad, chosen) in quads.iter_mut().zip(&chosen) {
                    *quad = &chosen.origin;
                }
                let [x, y, z, t_min] = s.load_quads(&quads);
                for (quad, chosen) in quads.iter_mut().zip(&chosen) {
                    *quad = &chosen.direction;
                }
                let [dx, dy, dz, t_max] = s.load_quads(&quads);
                let packet = Packet { origin: [x, y, z], direction: [dx, dy, dz], t_min, t_max };
                let mut nearest = [Nearest::new(f32::NEG_INFINITY); ROW];
                for (nearest, id) in nearest.iter_mut().zip(ids) {
                    *nearest = best[usize::from(*id)];
                }
                let pairs = Pairs {
                    block,
                    packet: &packet,
                    rays: pair_rays,
                    slots: pair_slots,
                    len: pairs,
                    any: ANY,
                };
                self.objects.pairs(s, &pairs, &mut nearest);
                for (lane, (nearest, id)) in nearest.iter().zip(ids).enumerate() {
                    let id = usize::from(*id);
                    if nearest.object != best[id].object {
                        best[id] = *nearest;
                        let limit = if ANY { Traveller::DONE } else { spans[id].limit(nearest.t) };
                        (limits[lane], changed) = (limit, changed | 1 << lane);
                    }
                }
            }
            while changed != 0 {
                let lane = changed.trailing_zeros() as usize % ROW;
                changed &= changed - 1;
                travellers[usize::from(ids[lane])].start[3] = limits[lane];
            }
        }
    }
}

/// Pairs of all rays of a packet and all objects of a block, and as many again to be written at once.
const PAIRS: usize = (ROW + 1) * lanes::BLOCK;

/// Sorts the rays to the children that they meet, and puts these on the stack, the one that they enter first on top.
#[inline(always)]
fn visit<S: Simd, One>(s: S, node: &Node, negative: &[bool; 3], at: Waiting, room: &mut Room<One>) {
    let Room { travellers, lists, stack, .. } = room;
    let (first, len, top) = (at.first as usize, at.len as usize, at.top as usize);
    let stride = len.next_multiple_of(SHARE) + SHARE;
    let end = top + WIDTH * stride;
    if lists.len() < end {
        lists.resize(2 * end, 0);
    }
    let (before, after) = lists.split_at_mut(top);
    let mut lens = [0; WIDTH];
    let mut sums = [0.0; ROW];
    for list in before[first..first + len].chunks(SHARE) {
        let (mut ids, mut marks) = ([0; SHARE], [0; SHARE]);
        ids[..list.len()].copy_from_slice(list);
        for lane in (0..WIDTH).step_by(S::LANES) {
            let side = |axis: usize, far: bool| if negative[axis] == far { axis } else { axis + 3 };
            let mut near = [s.splat(0.0); 3];
            let mut far = near;
            for axis in 0..3 {
                near[axis] = s.load(&node.boxes[side(axis, false)].0[lane..]);
                far[axis] = s.load(&node.boxes[side(axis, true)].0[lane..]);
            }
            let mut sum = s.load(&sums[lane..]);
            for (id, marks) in list.iter().zip(&mut marks) {
                let Traveller { start, inverse, .. } = &travellers[usize::from(*id)];
                let mut enter = s.splat(0.0);
                let mut exit = s.splat(start[3]);
                for axis in 0..3 {
                    let (start, inverse) = (s.splat(start[axis]), s.splat(inverse[axis]));
                    enter = s.max(enter, s.mul(s.sub(near[axis], start), inverse));
                    exit = s.min(exit, s.mul(s.sub(far[axis], start), inverse));
                }
                let met = s.le(enter, exit);
                *marks |= (s.bits(met) << lane) as u16;
                sum = s.add(sum, s.select(met, enter, s.splat(0.0)));
            }
            s.store(sum, &mut sums[lane..]);
        }
        s.distribute(&ids, &marks, after, stride, &mut lens);
    }
    // The last first.
    let begin = stack.len();
    for child in 0..WIDTH {
        if lens[child] > 0 {
            sums[child] /= lens[child] as f32;
            let waiting = Waiting {
                what: child as u32,
                first: (top + child * stride) as u32,
                len: lens[child],
                top: end as u32,
            };
            let mut place = stack.len();
            stack.push(waiting);
            while place > begin && sums[stack[place - 1].what as usize] < sums[child] {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = waiting;
        }
    }
    for waiting in &mut stack[begin..] {
        waiting.what = node.children[waiting.what as usize];
    }
}

/// The ways of rays through a block, in its own coordinates.
struct Paths {
    /// Rays that meet it.
    met: u32,
    /// The axis along which each goes farthest.
    axes: [u32; ROW],
    /// The fields of [`Path`].
    rows: [[f32; ROW]; 6],
}

impl Paths {
    #[inline(always)]
    fn of<S: Simd>(
        s: S,
        maps: &BlockMaps,
        negative: &[bool; 3],
        chosen: &[&Traveller; ROW],
        len: usize,
    ) -> Self {
        let mut quads = [&chosen[0].start; ROW];
        for (quad, chosen) in quads.iter_mut().zip(chosen) {
            *quad = &chosen.start;
        }
        let [x, y, z, limit] = s.load_quads(&quads);
        for (quad, chosen) in quads.iter_mut().zip(chosen) {
            *quad = &chosen.inverse;
        }
        let [ix, iy, iz, _] = s.load_quads(&quads);
        for (quad, chosen) in quads.iter_mut().zip(chosen) {
            *quad = &chosen.delta;
        }
        let [dx, dy, dz, _] = s.load_quads(&quads);
        let (start, inverse, delta) = ([x, y, z], [ix, iy, iz], [dx, dy, dz]);
        let (zero, last) = (s.splat(0.0), s.splat(lanes::path::SLICES as f32));
        let (mut enter, mut exit) = (zero, limit);
        let (mut from, mut to, mut way, mut size) = ([zero; 3], [zero; 3], [zero; 3], [zero; 3]);
        for axis in 0..3 {
            let density = s.splat(maps.density[axis]);
            from[axis] = s.mul(s.sub(start[axis], s.splat(maps.origin[axis])), density);
            way[axis] = s.mul(delta[axis], density);
            let per_slice = s.mul(inverse[axis], s.splat(1.0 / maps.density[axis]));
            let (near, far) = if negative[axis] { (last, zero) } else { (zero, last) };
            enter = s.max(enter, s.mul(s.sub(near, from[axis]), per_slice));
            exit = s.min(exit, s.mul(s.sub(far, from[axis]), per_slice));
        }
        let met = s.bits(s.le(enter, exit)) & (u32::MAX >> (32 - len));
        for axis in 0..3 {
            to[axis] = s.add(from[axis], s.mul(exit, way[axis]));
            from[axis] = s.add(from[axis], s.mul(enter, way[axis]));
            way[axis] = s.sub(to[axis], from[axis]);
            size[axis] = s.abs(way[axis]);
        }
        let second = s.lt(size[0], size[1]);
        let third = s.lt(s.max(size[0], size[1]), size[2]);
        let mut rows = [[0.0; ROW]; 6];
        let mut chosen = [zero; 6];
        for axis in 0..3 {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let begin = if negative[axis] { &to } else { &from };
            let nonzero = s.lt(zero, size[axis]);
            let per_slice = s.select(nonzero, s.div(s.splat(1.0), way[axis]), zero);
            let here = [
                begin[axis],
                s.add(begin[axis], size[axis]),
                begin[b],
                begin[c],
                s.mul(way[b], per_slice),
                s.mul(way[c], per_slice),
            ];
            for (chosen, here) in chosen.iter_mut().zip(here) {
                *chosen = match axis {
                    0 => here,
                    1 => s.select(second, here, *chosen),
                    _ => s.select(third, here, *chosen),
                };
            }
        }
        for (row, chosen) in rows.iter_mut().zip(chosen) {
            s.store(chosen, row);
        }
        let (second, third) = (s.bits(second), s.bits(third));
        let mut axes = [0; ROW];
        for (lane, axis) in axes.iter_mut().enumerate() {
            *axis = if third >> lane & 1 != 0 { 2 } else { second >> lane & 1 };
        }
        Self { met, axes, rows }
    }

    #[inline(always)]
    fn path(&self, lane: usize) -> Path {
        let [low, high, b, c, slope_b, slope_c] = &self.rows;
        Path {
            low: low[lane],
            high: high[lane],
            start: [b[lane], c[lane]],
            slope: [slope_b[lane], slope_c[lane]],
        }
    }
}
