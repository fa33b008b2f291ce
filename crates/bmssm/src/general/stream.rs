//! Many rays through the levels together: each node sorts the rays that reach it to its children, so that its boxes are
//! read once for all of them and no ray waits for itself (R. Barringer, T. Akenine-Möller, *Dynamic Ray Stream Traversal*, ACM
//! Transactions on Graphics 33(4), 2014).

use super::General;
use super::maps::BlockMaps;
use super::ready::{Begun, Room, STREAM, Waiting};
use super::traveller::{Traveller, Way};
use super::tree::{Node, WIDTH};
use accel::{Count, Nearest, Ray};
use lanes::packet::{Packet, Pairs};
use lanes::path::Path;
use lanes::{Blocks, PackedObjects, ROW, SHARE, Simd, prefetch};

/// Rays of a stream over few blocks, whose rays fit into a cache of the second level.
const SHORT_STREAM: usize = 1 << 14;

/// From this many blocks on streams are long: in short ones too few rays would reach each block.
const MANY_BLOCKS: usize = 1 << 11;

/// So many objects in one block are tested with every ray, sooner than rays are prepared for anything else.
const FEW: usize = 8;

impl<O: PackedObjects> General<O> {
    /// Rays that are best taken together.
    pub(super) fn stream_len(&self) -> usize {
        if self.maps.len() < MANY_BLOCKS { SHORT_STREAM } else { STREAM }
    }

    /// The nearest hits of up to [`STREAM`] rays, or for `ANY` some hit, left in `room.best`.
    #[inline(always)]
    pub(super) fn stream<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        rays: &[Ray],
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        if self.len <= FEW && self.maps.len() <= 1 {
            return self.test_all::<S, C, ANY>(s, rays, room, count);
        }
        let Begun { octants, top } = self.begin(s, rays, room);
        for (octant, ready) in octants.iter().enumerate() {
            if ready.len > 0 {
                room.stack.push(Waiting { what: 0, first: ready.first, len: ready.len, top });
                self.drain::<S, C, ANY>(s, octant, rays, room, count);
            }
            if ready.beams > 0 {
                self.drain_beams::<S, C, ANY>(s, octant, ready, top, room, count);
            }
        }
        if O::Blocks::takes_pairs::<S>() {
            self.objects.resolve_each(s, rays, &mut room.best[..rays.len()]);
        } else {
            for (one, best) in room.ones.iter().zip(&mut room.best) {
                self.objects.resolve(one, best);
            }
        }
    }

    /// Takes rays of one octant through all that they meet.
    #[inline(always)]
    fn drain<S: Simd, C: Count, const ANY: bool>(
        &self,
        s: S,
        octant: usize,
        rays: &[Ray],
        room: &mut Room<<O::Blocks as Blocks>::One>,
        count: &mut C,
    ) {
        let negative = [octant & 1 != 0, octant & 2 != 0, octant & 4 != 0];
        while let Some(next) = room.stack.pop() {
            if next.what & Node::BLOCK == 0 {
                count.cells(u64::from(next.len));
                let Room { travellers, lists, stack, .. } = &mut *room;
                visit(s, &self.nodes[next.what as usize], &negative, next, travellers, lists, stack);
                for waiting in room.stack.iter().rev().take(2) {
                    self.ask_for(waiting.what);
                }
            } else {
                count.blocks(u64::from(next.len));
                self.objects.prefetch((next.what & !Node::BLOCK) as usize);
                self.block::<S, C, ANY>(s, &negative, next, rays, room, count);
            }
        }
    }

    #[inline(always)]
    pub(super) fn ask_for(&self, what: u32) {
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
        rays: &[Ray],
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
                let mut chosen = [&rays[usize::from(ids[0])]; ROW];
                for (chosen, id) in chosen.iter_mut().zip(ids) {
                    *chosen = &rays[usize::from(*id)];
                }
                let packet = Packet::gather(s, &chosen);
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
                    if nearest.object != best[id].object || nearest.t != best[id].t {
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

/// Sorts the rays to the children that they meet, and puts these on the stack, the one that they enter first on top.
#[inline(always)]
pub(super) fn visit<S: Simd, W: Way>(
    s: S,
    node: &Node,
    negative: &[bool; 3],
    at: Waiting,
    ways: &[W],
    lists: &mut Vec<u16>,
    stack: &mut Vec<Waiting>,
) {
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
                let way = &ways[usize::from(*id)];
                let (first, last) = (way.near(), way.far());
                let mut enter = s.splat(0.0);
                let mut exit = s.splat(first.start[3]);
                for axis in 0..3 {
                    let (start, inverse) = (s.splat(first.start[axis]), s.splat(first.inverse[axis]));
                    enter = s.max(enter, s.mul(s.sub(near[axis], start), inverse));
                    let (start, inverse) = (s.splat(last.start[axis]), s.splat(last.inverse[axis]));
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
        let (start, inverse) = ([x, y, z], [ix, iy, iz]);
        let (zero, last) = (s.splat(0.0), s.splat(lanes::path::SLICES as f32));
        let (mut enter, mut exit) = (zero, limit);
        let (mut from, mut to, mut way, mut size) = ([zero; 3], [zero; 3], [zero; 3], [zero; 3]);
        for axis in 0..3 {
            let density = s.splat(maps.density[axis]);
            from[axis] = s.mul(s.sub(start[axis], s.splat(maps.origin[axis])), density);
            let per_slice = s.mul(inverse[axis], s.splat(1.0 / maps.density[axis]));
            way[axis] = s.div(s.splat(1.0), per_slice);
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
