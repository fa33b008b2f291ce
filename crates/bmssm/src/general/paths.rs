//! Rays at a block.

use super::boxes::{BlockBoxes, LocalRays};
use super::maps::BlockMaps;
use super::scratch::PairList;
use super::state::TraversalState;
use lanes::path::PathRows;
use lanes::{BLOCK, ROW, Row, Simd, Task, next_lane};

/// The candidates of up to `LANES` rays in a block, R & S & T along the path of each.
pub(super) struct Along<'a> {
    pub maps: &'a BlockMaps,
    /// Against which candidates are held, if there are any.
    pub boxes: Option<&'a BlockBoxes>,
    pub states: &'a [TraversalState],
    /// The rays, by number.
    pub ids: &'a [u16],
    /// Where rays and candidates are written down in pairs, if they are to be.
    pub pairs: Option<&'a mut PairList>,
}

impl Task for Along<'_> {
    type Out = [u64; ROW];

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> [u64; ROW] {
        let Self { maps, boxes, states, ids, mut pairs } = self;
        let mut chosen = [&states[usize::from(ids[0]) % states.len()]; ROW];
        for (chosen, id) in chosen.iter_mut().zip(ids) {
            *chosen = &states[usize::from(*id)];
        }
        let (paths, local) = Paths::of(s, maps, &chosen, ids.len());
        let mut masks = [0; ROW];
        let mut met = paths.met;
        while let Some(first) = next_lane(&mut met) {
            // Two at a time, a last odd one twice.
            let second = next_lane(&mut met).unwrap_or(first);
            let lanes = [first, second];
            let found = maps.along_both(s, lanes.map(|lane| paths.axes[lane] as usize), &paths.rows, lanes);
            let len = if first == second { 1 } else { 2 };
            for (lane, candidates) in lanes.into_iter().zip(found).take(len) {
                if let Some(pairs) = &mut pairs {
                    let slots = pairs.slots[pairs.len..].first_chunk_mut().expect("room for all pairs");
                    pairs.rays[pairs.len..pairs.len + BLOCK].fill(lane as u8);
                    pairs.len += s.set_bits(candidates, slots);
                    continue;
                }
                masks[lane] = match boxes {
                    Some(boxes) => boxes.met_by(s, maps, [chosen[lane]; 2], candidates),
                    None => candidates,
                };
            }
        }
        if let (Some(boxes), Some(pairs)) = (boxes, pairs) {
            boxes.keep_met(s, &local, pairs);
        }
        masks
    }
}

/// The ways of rays through a block, in its own coordinates.
struct Paths {
    /// Rays that meet it.
    met: u32,
    /// The axis along which each goes farthest.
    axes: [u32; ROW],
    rows: PathRows,
}

impl Paths {
    #[inline(always)]
    fn of<S: Simd>(
        s: S,
        maps: &BlockMaps,
        chosen: &[&TraversalState; ROW],
        len: usize,
    ) -> (Self, LocalRays<S>) {
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
        let mut per_slice = [zero; 3];
        for axis in 0..3 {
            let density = s.splat(maps.density[axis]);
            from[axis] = s.mul(s.sub(start[axis], s.splat(maps.origin[axis])), density);
            per_slice[axis] = s.mul(inverse[axis], s.splat(1.0 / maps.density[axis]));
            way[axis] = s.div(s.splat(1.0), per_slice[axis]);
            let backwards = s.lt(inverse[axis], zero);
            let (near, far) = (s.select(backwards, last, zero), s.select(backwards, zero, last));
            enter = s.max(enter, s.mul(s.sub(near, from[axis]), per_slice[axis]));
            exit = s.min(exit, s.mul(s.sub(far, from[axis]), per_slice[axis]));
        }
        let local = LocalRays::new(s, from, per_slice, limit);
        let met = s.bits(s.le(enter, exit)) & (u32::MAX >> (32 - len));
        for axis in 0..3 {
            to[axis] = s.add(from[axis], s.mul(exit, way[axis]));
            from[axis] = s.add(from[axis], s.mul(enter, way[axis]));
            way[axis] = s.sub(to[axis], from[axis]);
            size[axis] = s.abs(way[axis]);
        }
        let second = s.lt(size[0], size[1]);
        let third = s.lt(s.max(size[0], size[1]), size[2]);
        let mut rows = PathRows([Row([0.0; ROW]); 6]);
        let mut chosen = [zero; 6];
        for axis in 0..3 {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let backwards = s.lt(inverse[axis], zero);
            let mut begin = from;
            for (begin, to) in begin.iter_mut().zip(to) {
                *begin = s.select(backwards, to, *begin);
            }
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
        for (row, chosen) in rows.0.iter_mut().zip(chosen) {
            s.store(chosen, &mut row.0);
        }
        let (second, third) = (s.bits(second), s.bits(third));
        let mut axes = [0; ROW];
        for (lane, axis) in axes.iter_mut().enumerate() {
            *axis = if third >> lane & 1 != 0 { 2 } else { second >> lane & 1 };
        }
        (Self { met, axes, rows }, local)
    }
}
