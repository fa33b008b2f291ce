//! Rays and spheres in pairs, tested exactly: bounds in single precision come first, and only those that may still be a ray's
//! nearest are computed, sixteen at a time.

use crate::blocks::{SolidBlocks, precedes};
use crate::exact_blocks::Met;
use crate::paired::{Group, Rays, values};
use crate::rows::{Spheres, Values};
use accel::{Nearest, Surface};
use lanes::packet::{Pairs, RayRows};
use lanes::{BLOCK, ROW, Simd, ones};

/// So many pairs wait at most.
const MAX: usize = 128;

/// Pairs that may hit.
pub(crate) struct Waiting {
    len: usize,
    places: [u8; MAX],
    slots: [u8; MAX],
    /// What hits does so at this t or above.
    low: [f32; MAX],
    /// Up to what t each ray hits for certain.
    limits: [f32; ROW],
}

impl Waiting {
    /// None, of rays that look so far.
    #[inline(always)]
    pub fn new(t_max: &[f32; ROW]) -> Self {
        Self { len: 0, places: [0; MAX], slots: [0; MAX], low: [0.0; MAX], limits: *t_max }
    }

    /// Whether there may be no room for another group.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.len > MAX - ROW
    }

    /// Those of the wanted pairs of a group that may hit. There must be room.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, s: S, spheres: &Values<S>, group: &Group, wanted: u32, rays: &Rays<S>) {
        let (prepared, _) = rays.permuted(s, group);
        let limits = s.permute(s.load(&self.limits), s.load_bytes(group.rays));
        let bounds = Spheres::bounds(s, &prepared, spheres, limits);
        let maybe = s.bits(bounds.maybe) & wanted;
        if maybe == 0 {
            return;
        }
        let (mut low, mut high) = ([0.0; ROW], [0.0; ROW]);
        s.store(bounds.low, &mut low);
        s.store(bounds.high, &mut high);
        let closer = s.and(bounds.certain, s.lt(bounds.high, limits));
        for lane in ones(u64::from(s.bits(closer) & maybe)) {
            let limit = &mut self.limits[group.pair(lane).1];
            if high[lane] < *limit {
                *limit = high[lane];
            }
        }
        for lane in ones(maybe.into()) {
            (self.places[self.len], self.slots[self.len]) = (group.rays[lane], group.slots[lane]);
            self.low[self.len] = low[lane];
            self.len += 1;
        }
    }

    /// Moves up to [`ROW`] pairs from `next` on, which may still be their rays' nearest, to the front of `places` and `slots`; how many.
    #[inline(always)]
    fn choose(
        &self,
        next: &mut usize,
        t_max: &[f32; ROW],
        (places, slots): (&mut [u8; ROW], &mut [u8; ROW]),
    ) -> usize {
        let mut len = 0;
        while len < ROW && *next < self.len {
            let place = usize::from(self.places[*next]) % ROW;
            (places[len], slots[len]) = (self.places[*next], self.slots[*next]);
            len += usize::from(self.low[*next] <= self.limits[place].min(t_max[place]));
            *next += 1;
        }
        len
    }
}

impl SolidBlocks<'_> {
    /// Tests the pairs that wait, so that none do.
    #[inline(always)]
    pub(crate) fn settle<S: Simd>(
        &self,
        s: S,
        pairs: &Pairs<'_, S>,
        waiting: &mut Waiting,
        rays: &mut Rays<S>,
        best: &mut [Nearest; ROW],
    ) {
        let (mut next, mut places, mut slots) = (0, [0; ROW], [0; ROW]);
        loop {
            let len = waiting.choose(&mut next, &rays.t_max, (&mut places, &mut slots));
            if len == 0 {
                break;
            }
            let group = Group { rays: &places, slots: &slots, len };
            let (prepared, _) = rays.permuted(s, &group);
            let numbers = values(s, &self.spheres, pairs.block, &group);
            let mut spheres = [[0.0; ROW]; 4];
            for (row, value) in spheres.iter_mut().zip(numbers) {
                s.store(value, row);
            }
            let rows = RayRows::of(s, &pairs.packet.permuted(s, s.load_bytes(&places)));
            let Met { t, hits } = Met::of::<S>(&spheres, &rows, u32::MAX >> (32 - len));
            let plain = s.bits(Spheres::is_plain(s, &prepared, &numbers, s.load(&t)));
            for lane in ones(hits.into()) {
                let (slot, place) = group.pair(lane);
                let (t, object) = (t[lane], self.ids.get(pairs.block * BLOCK + slot));
                if t > rays.t_max[place] || !precedes(t, object, &best[place]) {
                    continue;
                }
                if plain >> lane & 1 != 0 || self.solids.holds(object, &rows.ray(lane), t) {
                    best[place].offer(object, Surface { t, u: 0.0, v: 0.0 });
                    rays.found(place, t);
                }
            }
        }
        waiting.len = 0;
        waiting.limits = rays.t_max;
    }
}
