//! Rays and solids of a block in pairs, one pair in each lane.

use crate::blocks::{SolidBlocks, precedes};
use crate::exact::nearest;
use crate::group::Kind;
use crate::rows::{MOST_ROWS, Packing, Prepared, Spheres, Values};
use accel::solid::Sphere;
use accel::{Nearest, Ray, Surface, Vec3};
use lanes::packet::{Pairs, RayRows};
use lanes::{BLOCK, EMPTY_SLOT, ROW, Row, Simd};

/// What stands for a row of slots that holds none of a kind.
static NONE: Row = Row([0.0; ROW]);

/// The rays of pairs.
struct Rays<S: Simd> {
    prepared: Prepared<S::F>,
    rows: RayRows,
    /// Those that single precision is enough for.
    near: u32,
    /// Up to what t each looks.
    t_max: [f32; ROW],
    any: bool,
}

/// Pairs that are tested at once.
struct Group<'a> {
    /// Places of the rays.
    rays: &'a [u8],
    /// Places of the objects in the block.
    slots: &'a [u8],
    len: usize,
}

impl Group<'_> {
    /// The lanes whose objects have a bit.
    #[inline(always)]
    fn lanes(&self, objects: u64) -> u32 {
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
    fn of_rays(&self, rays: u32) -> u32 {
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
    fn pair(&self, lane: usize) -> (usize, usize) {
        (usize::from(self.slots[lane]), usize::from(self.rays[lane]) % ROW)
    }
}

impl<S: Simd> Rays<S> {
    #[inline(always)]
    fn permuted(&self, s: S, group: &Group) -> (Prepared<S::F>, S::F) {
        let at = s.load_bytes(group.rays);
        (self.prepared.permuted(s, at), s.permute(s.load(&self.t_max), at))
    }

    /// Lets a ray look no farther than a hit, or no more if any hit will do.
    #[inline(always)]
    fn found(&mut self, place: usize, t: f32) {
        self.t_max[place] = if self.any { f32::NEG_INFINITY } else { t };
    }
}

impl SolidBlocks<'_> {
    /// Tests rays and objects in pairs: those of packed kinds and near rays in lanes, the others one by one.
    #[inline(always)]
    pub(crate) fn test_pairs<S: Simd>(&self, s: S, pairs: &Pairs<'_, S>, best: &mut [Nearest; ROW]) {
        let mut t_max = [0.0; ROW];
        for (t_max, best) in t_max.iter_mut().zip(&*best) {
            *t_max = best.t;
        }
        let frame = &self.solids.frame;
        let mut rays = Rays {
            prepared: Prepared::of(s, pairs.packet, frame.pad),
            rows: RayRows::of(s, pairs.packet),
            near: s.bits(frame.near(s, pairs.packet)),
            t_max,
            any: pairs.any,
        };
        let (spheres, cones, triangles) = (
            self.spheres.block(pairs.block),
            self.cones.block(pairs.block),
            self.triangles.block(pairs.block),
        );
        for at in (0..pairs.len).step_by(S::LANES) {
            let len = S::LANES.min(pairs.len - at);
            let group = Group { rays: &pairs.rays[at..], slots: &pairs.slots[at..], len };
            let near = group.of_rays(rays.near);
            let mut left = group.lanes(u64::MAX);
            let wanted = group.lanes(spheres) & near;
            if wanted != 0 {
                if self.is_exact() {
                    self.exact_pairs(s, pairs.block, &group, wanted, &mut rays, best);
                } else {
                    self.kind_in_pairs(s, (&self.spheres, pairs.block), &group, wanted, &mut rays, best);
                }
                left &= !wanted;
            }
            let wanted = group.lanes(cones) & left & near;
            if wanted != 0 {
                self.kind_in_pairs(s, (&self.cones, pairs.block), &group, wanted, &mut rays, best);
                left &= !wanted;
            }
            let wanted = group.lanes(triangles) & left & near;
            if wanted != 0 {
                self.kind_in_pairs(s, (&self.triangles, pairs.block), &group, wanted, &mut rays, best);
                left &= !wanted;
            }
            while left != 0 {
                let (slot, place) = group.pair(left.trailing_zeros() as usize);
                left &= left - 1;
                let object = self.ids.get(pairs.block * BLOCK + slot);
                if object != EMPTY_SLOT && rays.t_max[place] != f32::NEG_INFINITY {
                    self.one_in_pair(object, &rays.rows.ray(place), &mut best[place]);
                    if best[place].object == object {
                        rays.found(place, best[place].t);
                    }
                }
            }
        }
    }

    #[inline(never)]
    fn one_in_pair(&self, object: u32, ray: &Ray, best: &mut Nearest) {
        accel::Objects::closest(&self.solids, object, ray, best);
    }

    /// The wanted lanes, whose objects are all of a kind.
    #[inline(always)]
    fn kind_in_pairs<K: Packing, S: Simd>(
        &self,
        s: S,
        (kind, block): (&Kind<K>, usize),
        group: &Group,
        wanted: u32,
        rays: &mut Rays<S>,
        best: &mut [Nearest; ROW],
    ) {
        let (prepared, t_max) = rays.permuted(s, group);
        let found = K::test(s, &prepared, &values(s, kind, block, group), t_max);
        let mut hits = s.bits(found.lanes.hit) & wanted;
        if hits == 0 {
            return;
        }
        let plain = s.bits(found.plain);
        let rows = found.lanes.rows(s);
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize % ROW;
            hits &= hits - 1;
            let (slot, place) = group.pair(lane);
            let object = self.ids.get(block * BLOCK + slot);
            let (t, best) = (rows.t[lane], &mut best[place]);
            if precedes(t, object, best)
                && (plain >> lane & 1 != 0 || self.solids.holds(object, &rays.rows.ray(place), t))
            {
                best.offer(object, rows.surface(lane));
                rays.found(place, t);
            }
        }
    }

    /// Spheres, exactly.
    #[inline(always)]
    fn exact_pairs<S: Simd>(
        &self,
        s: S,
        block: usize,
        group: &Group,
        wanted: u32,
        rays: &mut Rays<S>,
        best: &mut [Nearest; ROW],
    ) {
        let (prepared, t_max) = rays.permuted(s, group);
        let values = values(s, &self.spheres, block, group);
        let bounds = Spheres::bounds(s, &prepared, &values, t_max);
        let mut maybe = s.bits(bounds.maybe) & wanted;
        if maybe == 0 {
            return;
        }
        let mut numbers = [[0.0; ROW]; 4];
        for (numbers, value) in numbers.iter_mut().zip(values) {
            s.store(value, numbers);
        }
        let (mut low, mut high) = ([0.0; ROW], [0.0; ROW]);
        s.store(bounds.low, &mut low);
        s.store(bounds.high, &mut high);
        // Up to what t hits are certain before any is computed.
        let mut limits = rays.t_max;
        let mut certain = s.bits(bounds.certain) & maybe;
        while certain != 0 {
            let lane = certain.trailing_zeros() as usize % ROW;
            certain &= certain - 1;
            let place = group.pair(lane).1;
            limits[place] = limits[place].min(high[lane]);
        }
        while maybe != 0 {
            let lane = maybe.trailing_zeros() as usize % ROW;
            maybe &= maybe - 1;
            let (slot, place) = group.pair(lane);
            if low[lane] > limits[place] || low[lane] > rays.t_max[place] {
                continue;
            }
            let [x, y, z, radius] = numbers.map(|row| row[lane]);
            let sphere = Sphere { center: Vec3::new(x, y, z), radius };
            let ray = rays.rows.ray(place);
            let Some(t) = nearest(&sphere, &ray, best[place].t) else { continue };
            let object = self.ids.get(block * BLOCK + slot);
            if precedes(t, object, &best[place]) && self.solids.holds(object, &ray, t) {
                best[place].offer(object, Surface { t, u: 0.0, v: 0.0 });
                rays.found(place, t);
            }
        }
    }
}

/// The numbers of the objects in the lanes.
#[inline(always)]
fn values<K: Packing, S: Simd>(s: S, kind: &Kind<K>, block: usize, group: &Group) -> Values<S> {
    let at = s.load_bytes(group.slots);
    let mut values = [s.splat(0.0); MOST_ROWS];
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
