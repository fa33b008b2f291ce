//! Sixteen pairs of a ray and an object of a block, one in each lane.

use crate::frame::Frame;
use crate::group::Kind;
use crate::rows::{MAX_ROWS, Packing, Prepared, Values};
use accel::Nearest;
use lanes::packet::{Pairs, RayRows};
use lanes::{BLOCK, ROW, Row, Simd};

/// What stands for a row of slots that holds none of a kind.
static NONE: Row = Row([0.0; ROW]);

/// The rays of pairs.
pub struct Rays<S: Simd> {
    prepared: Prepared<S::F>,
    /// As they are.
    pub rows: RayRows,
    /// Those that single precision is enough for.
    pub near: u32,
    /// Up to what t each looks.
    pub t_max: [f32; ROW],
    any: bool,
}

/// Pairs that are tested at once.
pub struct Group<'a> {
    /// Places of the rays.
    pub rays: &'a [u8],
    /// Places of the objects in the block.
    pub slots: &'a [u8],
    /// How many there are.
    pub len: usize,
}

impl Group<'_> {
    /// The lanes whose objects have a bit.
    #[inline(always)]
    pub fn lanes(&self, objects: u64) -> u32 {
        let all = u32::MAX >> (32 - self.len);
        if objects == u64::MAX {
            return all;
        }
        let mut lanes = 0;
        for (lane, slot) in self.slots[..ROW].iter().enumerate() {
            lanes |= ((objects >> (slot % 64)) as u32 & 1) << lane;
        }
        lanes & all
    }

    /// The lanes whose rays have a bit.
    #[inline(always)]
    pub fn of_rays(&self, rays: u32) -> u32 {
        if rays == u32::MAX >> (32 - ROW) {
            return rays;
        }
        self.rays[..ROW]
            .iter()
            .enumerate()
            .fold(0, |lanes, (lane, ray)| lanes | (rays >> (ray % 32) & 1) << lane)
    }

    /// The slot in the block and the place of the ray.
    #[inline(always)]
    pub fn pair(&self, lane: usize) -> (usize, usize) {
        (usize::from(self.slots[lane]), usize::from(self.rays[lane]) % ROW)
    }
}

impl<S: Simd> Rays<S> {
    /// Those of pairs, with the hits so far.
    #[inline(always)]
    pub fn of(s: S, pairs: &Pairs<'_, S>, frame: &Frame, best: &[Nearest; ROW]) -> Self {
        let mut t_max = [0.0; ROW];
        for (t_max, best) in t_max.iter_mut().zip(best) {
            *t_max = best.t;
        }
        Self {
            prepared: Prepared::of(s, pairs.packet, frame.pad),
            rows: RayRows::of(s, pairs.packet),
            near: s.bits(frame.near(s, pairs.packet)),
            t_max,
            any: pairs.any,
        }
    }

    /// What is the same for all objects, and up to what t each looks, for the ray in each lane.
    #[inline(always)]
    pub fn permuted(&self, s: S, group: &Group) -> (Prepared<S::F>, S::F) {
        let at = s.load_bytes(group.rays);
        (self.prepared.permuted(s, at), s.permute(s.load(&self.t_max), at))
    }

    /// Lets a ray look no farther than a hit, or no more if any hit will do.
    #[inline(always)]
    pub fn found(&mut self, place: usize, t: f32) {
        self.t_max[place] = if self.any { f32::NEG_INFINITY } else { t };
    }
}

/// The numbers of the objects in the lanes.
#[inline(always)]
pub fn values<K: Packing, S: Simd>(s: S, kind: &Kind<K>, block: usize, group: &Group) -> Values<S> {
    let at = s.load_bytes(group.slots);
    let mut values = [s.splat(0.0); MAX_ROWS];
    let first = block * (BLOCK / ROW);
    let rows =
        [kind.rows_of(first), kind.rows_of(first + 1), kind.rows_of(first + 2), kind.rows_of(first + 3)];
    for (i, value) in values.iter_mut().enumerate().take(K::ROWS) {
        let mut table = [&NONE; 4];
        for (entry, rows) in table.iter_mut().zip(rows) {
            *entry = rows.get(i).unwrap_or(&NONE);
        }
        *value = s.lookup(table, at);
    }
    values
}
