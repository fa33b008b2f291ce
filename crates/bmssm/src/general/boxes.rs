//! The boxes of a block's objects, of six bytes each: what its maps let pass is held against them where geometry is far to fetch.

use super::maps::BlockMaps;
use super::scratch::PairList;
use super::sides::Sides;
use super::state::TraversalState;
use lanes::packet::Overlap;
use lanes::path::SLICES;
use lanes::split::whole;
use lanes::{BLOCK, Simd};

/// Places of a box's sides in a slice of the block's maps.
const STEPS: f32 = u8::MAX as f32 / SLICES as f32;

/// The boxes of up to 64 objects, rounded outwards to steps of the block's own box.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct BlockBoxes {
    low: [[u8; BLOCK]; 3],
    high: [[u8; BLOCK]; 3],
}

impl BlockBoxes {
    /// Of no objects.
    pub const EMPTY: Self = Self { low: [[u8::MAX; BLOCK]; 3], high: [[0; BLOCK]; 3] };

    /// Those of a block's objects, widened as they are registered in its maps.
    #[inline(always)]
    pub fn new<S: Simd>(s: S, maps: &BlockMaps, sides: &Sides) -> Self {
        let mut boxes = Self::EMPTY;
        let (steps, half, end) = (s.splat(STEPS), s.splat(0.5), s.splat(f32::from(u8::MAX)));
        for axis in 0..3 {
            let (mut first, mut last) = ([0.0; BLOCK], [0.0; BLOCK]);
            for at in (0..BLOCK).step_by(S::LANES) {
                let [low, high] = maps.spans(s, axis, sides, at);
                let (low, high) = (s.mul(low, steps), s.mul(high, steps));
                // Half a step outwards, for they are rounded to the nearest step.
                s.store(s.min(s.max(s.sub(low, half), s.splat(0.0)), end), &mut first[at..]);
                s.store(s.min(s.max(s.add(high, half), s.splat(0.0)), end), &mut last[at..]);
            }
            boxes.low[axis] = first.map(|step| whole(step) as u8);
            boxes.high[axis] = last.map(|step| whole(step) as u8);
        }
        boxes
    }

    /// Of candidates those whose box is met by rays between two, as at a node: one that enters boxes no later than any of them
    /// and one that leaves them no sooner, both of one octant. For a single ray both are the same.
    #[inline(always)]
    pub fn met_by<S: Simd>(
        &self,
        s: S,
        maps: &BlockMaps,
        [near, far]: [&TraversalState; 2],
        candidates: u64,
    ) -> u64 {
        let mut met = 0;
        for at in (0..BLOCK).step_by(S::LANES) {
            if candidates >> at & (u64::MAX >> (BLOCK - S::LANES)) == 0 {
                continue;
            }
            let (mut enter, mut exit) = (s.splat(0.0), s.splat(near.start[3]));
            for axis in 0..3 {
                let low = s.load_bytes_as_floats(&self.low[axis][at..]);
                let high = s.load_bytes_as_floats(&self.high[axis][at..]);
                let backwards = near.inverse[axis].is_sign_negative();
                let (first, last) = if backwards { (high, low) } else { (low, high) };
                let [from_near, from_far] = maps.local_pair(axis, [near.start[axis], far.start[axis]]);
                let per_step = 1.0 / (maps.density[axis] * STEPS);
                let way = s.sub(first, s.splat(from_near * STEPS));
                enter = s.max(enter, s.mul(way, s.splat(near.inverse[axis] * per_step)));
                let way = s.sub(last, s.splat(from_far * STEPS));
                exit = s.min(exit, s.mul(way, s.splat(far.inverse[axis] * per_step)));
            }
            met |= u64::from(s.bits(s.le(enter, exit))) << at;
        }
        met & candidates
    }

    /// Keeps the pairs whose ray meets the box of the object.
    #[inline(always)]
    pub fn keep_met<S: Simd>(&self, s: S, rays: &LocalRays<S>, pairs: &mut PairList) {
        let mut kept = 0;
        for first in (0..pairs.len).step_by(BLOCK) {
            let (mut met, len) = (0, BLOCK.min(pairs.len - first));
            for at in (0..len).step_by(S::LANES) {
                let ray = s.load_bytes(&pairs.rays[first + at..]);
                let slot = s.load_bytes(&pairs.slots[first + at..]);
                met |= u64::from(s.bits(self.meet(s, rays, ray, slot))) << at;
            }
            met &= u64::MAX >> (BLOCK - len);
            for bytes in [&mut pairs.rays, &mut pairs.slots] {
                let from: [u8; BLOCK] = *bytes[first..].first_chunk().expect("room for all pairs");
                s.compress(met, &from, bytes[kept..].first_chunk_mut().expect("room for all pairs"));
            }
            kept += met.count_ones() as usize;
        }
        pairs.len = kept;
    }

    /// Of pairs in lanes those whose ray meets the box of the object.
    #[inline(always)]
    fn meet<S: Simd>(&self, s: S, rays: &LocalRays<S>, ray: S::U, slot: S::U) -> S::M {
        let mut overlap = Overlap::up_to(s, s.permute(rays.limit, ray));
        for axis in 0..3 {
            let from = s.permute(rays.from[axis], ray);
            let per_step = s.permute(rays.per_step[axis], ray);
            let sides = [s.lookup_bytes(&self.low[axis], slot), s.lookup_bytes(&self.high[axis], slot)];
            overlap.cut(s, sides, from, per_step);
        }
        overlap.lanes(s)
    }
}

/// Rays in steps of a block's box.
#[derive(Clone, Copy)]
pub(super) struct LocalRays<S: Simd> {
    /// Where they begin.
    from: [S::F; 3],
    /// The part of the way that a step takes.
    per_step: [S::F; 3],
    /// The place up to which objects must be looked at.
    limit: S::F,
}

impl<S: Simd> LocalRays<S> {
    /// From where they begin in slices, and the part of the way that a slice takes.
    #[inline(always)]
    pub fn new(s: S, from: [S::F; 3], per_slice: [S::F; 3], limit: S::F) -> Self {
        let (mut local, steps, slices) =
            (Self { from, per_step: per_slice, limit }, s.splat(STEPS), s.splat(1.0 / STEPS));
        for axis in 0..3 {
            local.from[axis] = s.mul(from[axis], steps);
            local.per_step[axis] = s.mul(per_slice[axis], slices);
        }
        local
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::tolerance::LOCAL_MARGIN;
    use lanes::split::{Extremes, Item, UnitBox};
    use lanes::{Level, Task};
    use proptest::prelude::*;

    struct Kept<'a>(&'a [Item]);

    impl Task for Kept<'_> {
        type Out = (BlockMaps, BlockBoxes);

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> Self::Out {
            let sides = Sides::of(self.0);
            let maps = BlockMaps::new(s, &Extremes::of(self.0).bounds(), &sides);
            let boxes = BlockBoxes::new(s, &maps, &sides);
            (maps, boxes)
        }
    }

    proptest! {
        #[test]
        fn boxes_are_rounded_outwards_by_a_step_at_most(
            corners in prop::collection::vec((prop::array::uniform3(0.0..1.0f32), prop::array::uniform3(0.0..0.2f32)), 1..=BLOCK),
        ) {
            let bounds = |(min, size): &([f32; 3], [f32; 3])| UnitBox { min: *min, max: [0, 1, 2].map(|a| min[a] + size[a]) };
            let items: Vec<Item> = corners.iter().map(bounds).zip(0..).map(|(b, i)| Item::new(i, 1, &b)).collect();
            let (maps, boxes) = Level::Portable.run(Kept(&items));
            for (slot, item) in items.iter().enumerate() {
                let UnitBox { min, max } = item.bounds().widened();
                for axis in 0..3 {
                    let [low, high] = maps.local_pair(axis, [min[axis], max[axis]]);
                    let [low, high] = [(low - LOCAL_MARGIN) * STEPS, (high + LOCAL_MARGIN) * STEPS];
                    let [begin, end] = [boxes.low[axis][slot], boxes.high[axis][slot]].map(f32::from);
                    prop_assert!(begin <= low.max(0.0) && low < begin + 1.001, "{begin} {low}");
                    prop_assert!(high.min(255.0) <= end && (end - 1.001 < high), "{end} {high}");
                }
            }
            for level in Level::here() {
                let other = level.run(Kept(&items)).1;
                prop_assert!((&other.low, &other.high) == (&boxes.low, &boxes.high), "{:?}", level);
            }
        }
    }
}
