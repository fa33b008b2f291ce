//! Solids packed in blocks of 64: kinds that have rows are tested `LANES` at a time, others one by one.

use crate::frame::Frame;
use crate::group::{Group, Kind};
use crate::objects::{Precision, Solids};
use crate::rows::{Cones, Packing, Prepared, Spheres, Triangles};
use accel::{Nearest, Objects, Ray};
use lanes::packet::{Lanes, NearestPacket, Packet, Pairs};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, Ids, PackedObjects, ROW, Scalar, Simd};

/// Solids in blocks. Each row of 16 slots has a group of rows for each packed kind that is in it.
#[derive(Clone, Debug)]
pub struct SolidBlocks<'s> {
    pub(crate) solids: Solids<'s>,
    pub(crate) ids: Ids,
    pub(crate) spheres: Kind<Spheres>,
    pub(crate) cones: Kind<Cones>,
    pub(crate) triangles: Kind<Triangles>,
}

/// A ray prepared for solids.
#[derive(Clone, Copy, Debug)]
pub struct OneRay {
    pub(crate) ray: Ray,
    near: bool,
    pub(crate) prepared: Prepared<f32>,
}

/// A packet of rays prepared for solids.
#[derive(Clone, Copy)]
pub struct ManyRays<S: Simd> {
    pub(crate) rays: Packet<S>,
    pub(crate) near: S::M,
    pub(crate) prepared: Prepared<S::F>,
}

impl<'s> SolidBlocks<'s> {
    /// Slot i holds object `order[i]`.
    pub fn new(solids: Solids<'s>, order: &[u32]) -> Self {
        let (spheres, cones) = (Kind::new(&solids, order), Kind::new(&solids, order));
        let triangles = Kind::new(&solids, order);
        Self { solids, ids: Ids::new(order), spheres, cones, triangles }
    }

    fn frame(&self) -> &Frame {
        &self.solids.frame
    }

    pub(crate) fn is_exact(&self) -> bool {
        self.solids.precision() == Precision::Exact
    }

    #[inline(always)]
    fn one_by_one(&self, first: usize, mut mask: u32, ray: &Ray, best: &mut Nearest) {
        while mask != 0 {
            let object = self.ids.get(first + mask.trailing_zeros() as usize);
            mask &= mask - 1;
            if object != EMPTY_SLOT {
                self.solids.closest(object, ray, best);
            }
        }
    }

    /// Tests the wanted objects of a kind in a row, and tells which of the row are of this kind.
    #[inline(always)]
    fn row<K: Packing, S: Simd>(
        &self,
        s: S,
        kind: &Kind<K>,
        (number, wanted): (usize, u32),
        ray: &OneRay,
        best: &mut Nearest,
    ) -> u32 {
        let group = kind.group(number);
        if wanted & group.mask != 0 {
            self.group::<K, S>(s, (number * ROW, group), wanted & group.mask, ray, best);
        }
        group.mask
    }

    #[inline(always)]
    fn group<K: Packing, S: Simd>(
        &self,
        s: S,
        (first, group): (usize, Group<'_>),
        mask: u32,
        ray: &OneRay,
        best: &mut Nearest,
    ) {
        let prepared = ray.prepared.splat(s);
        let mut lane = 0;
        while lane < ROW {
            let wanted = mask >> lane & (u32::MAX >> (32 - S::LANES));
            if wanted != 0 {
                let values = crate::rows::load::<K, S>(s, group.rows, lane);
                let found = K::test(s, &prepared, &values, s.splat(best.t));
                let mut hits = s.bits(found.hit) & wanted;
                if hits != 0 {
                    let plain = s.bits(found.plain);
                    let (mut t, mut u, mut v) = ([0.0; ROW], [0.0; ROW], [0.0; ROW]);
                    s.store(found.t, &mut t);
                    s.store(found.u, &mut u);
                    s.store(found.v, &mut v);
                    while hits != 0 {
                        let at = hits.trailing_zeros() as usize;
                        hits &= hits - 1;
                        let object = self.ids.get(first + lane + at);
                        let comes = t[at] < best.t || (t[at] == best.t && object < best.object);
                        if comes && (plain >> at & 1 != 0 || self.solids.holds(object, &ray.ray, t[at])) {
                            *best = Nearest { t: t[at], object, u: u[at], v: v[at] };
                        }
                    }
                }
            }
            lane += S::LANES;
        }
    }

    /// One packed object against the near ones of `LANES` rays.
    #[inline(always)]
    fn packed<K: Packing, S: Simd>(
        &self,
        s: S,
        slot: usize,
        group: Group<'_>,
        rays: &ManyRays<S>,
        best: &mut NearestPacket<S>,
    ) {
        let object = self.ids.get(slot);
        let values = crate::rows::splat::<K, S>(s, group.rows, slot % ROW);
        let found = K::test(s, &rays.prepared, &values, best.t);
        let mut hit = s.and(found.hit, rays.near);
        let mut unsure = s.bits(hit) & !s.bits(found.plain);
        if unsure != 0 {
            let mut kept = s.bits(hit);
            let mut t = [0.0; ROW];
            s.store(found.t, &mut t);
            while unsure != 0 {
                let lane = unsure.trailing_zeros() as usize;
                unsure &= unsure - 1;
                if !self.solids.holds(object, &rays.rays.ray(s, lane), t[lane]) {
                    kept &= !(1 << lane);
                }
            }
            hit = s.mask(kept);
        }
        best.offer(s, object, &Lanes { hit, t: found.t, u: found.u, v: found.v });
    }

    /// One object against the rays of some lanes, one by one.
    fn lanes_one_by_one<S: Simd>(
        &self,
        s: S,
        object: u32,
        mut lanes: u32,
        rays: &Packet<S>,
        best: &mut NearestPacket<S>,
    ) {
        let mut nearest = [Nearest::new(0.0); ROW];
        best.store(s, &mut nearest);
        let (mut t, mut u, mut v) = ([0.0; ROW], [0.0; ROW], [0.0; ROW]);
        let mut wins = 0;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let mut after = nearest[lane];
            if after.t == f32::NEG_INFINITY {
                continue;
            }
            self.solids.closest(object, &rays.ray(s, lane), &mut after);
            wins |= u32::from(after.object != nearest[lane].object) << lane;
            (t[lane], u[lane], v[lane]) = (after.t, after.u, after.v);
        }
        let wins = s.mask(wins);
        best.take(s, wins, object, &Lanes { hit: wins, t: s.load(&t), u: s.load(&u), v: s.load(&v) });
    }
}

impl Blocks for SolidBlocks<'_> {
    type One = OneRay;
    type Many<S: Simd> = ManyRays<S>;

    fn bytes(&self) -> usize {
        self.ids.bytes() + self.spheres.bytes() + self.cones.bytes() + self.triangles.bytes()
    }

    #[inline]
    fn object(&self, slot: usize) -> u32 {
        self.ids.get(slot)
    }

    #[inline(always)]
    fn one(&self, ray: &Ray) -> OneRay {
        let packet = Packet::splat(Scalar, ray);
        OneRay {
            ray: *ray,
            near: self.frame().near(Scalar, &packet),
            prepared: Prepared::of(Scalar, &packet, self.frame().pad),
        }
    }

    #[inline(always)]
    fn many<S: Simd>(&self, s: S, rays: &Packet<S>) -> ManyRays<S> {
        let frame = self.frame();
        ManyRays { rays: *rays, near: frame.near(s, rays), prepared: Prepared::of(s, rays, frame.pad) }
    }

    #[inline(always)]
    fn closest<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &OneRay, best: &mut Nearest) {
        for row in 0..BLOCK / ROW {
            let mut wanted = (mask >> (row * ROW)) as u32 & 0xffff;
            if wanted == 0 {
                continue;
            }
            let (number, first) = (block * (BLOCK / ROW) + row, block * BLOCK + row * ROW);
            if ray.near {
                let spheres = self.spheres.group(number);
                if wanted & spheres.mask != 0 {
                    let wanted = wanted & spheres.mask;
                    match self.is_exact() {
                        true => self.exact_group(s, (first, spheres), wanted, ray, best),
                        false => self.group::<Spheres, S>(s, (first, spheres), wanted, ray, best),
                    }
                }
                wanted &= !spheres.mask;
                wanted &= !self.row(s, &self.cones, (number, wanted), ray, best);
                wanted &= !self.row(s, &self.triangles, (number, wanted), ray, best);
            }
            self.one_by_one(first, wanted, &ray.ray, best);
        }
    }

    /// Where bytes and tables are looked up in registers.
    #[inline(always)]
    fn takes_pairs<S: Simd>() -> bool {
        S::LANES == ROW
    }

    #[inline(always)]
    fn pairs<S: Simd>(&self, s: S, pairs: &Pairs<'_, S>, best: &mut [Nearest; ROW]) {
        self.test_pairs(s, pairs, best);
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &ManyRays<S>, best: &mut NearestPacket<S>) {
        let (number, bit) = (slot / ROW, 1 << (slot % ROW));
        let all = u32::MAX >> (32 - S::LANES);
        let mut left = all;
        let (spheres, cones, triangles) =
            (self.spheres.group(number), self.cones.group(number), self.triangles.group(number));
        if spheres.mask & bit != 0 {
            match self.is_exact() {
                true => self.exact_packed(s, slot, spheres, rays, best),
                false => self.packed::<Spheres, S>(s, slot, spheres, rays, best),
            }
            left &= !s.bits(rays.near);
        } else if cones.mask & bit != 0 {
            self.packed::<Cones, S>(s, slot, cones, rays, best);
            left &= !s.bits(rays.near);
        } else if triangles.mask & bit != 0 {
            self.packed::<Triangles, S>(s, slot, triangles, rays, best);
            left &= !s.bits(rays.near);
        }
        let object = self.ids.get(slot);
        if left != 0 && object != EMPTY_SLOT {
            self.lanes_one_by_one(s, object, left, &rays.rays, best);
        }
    }
}

/// Bytes of a slot, about: the number, a sphere's, a cone's or a triangle's rows, and what finds them.
const BYTES_OF_SLOT: u128 = 24;

impl<'s> PackedObjects for Solids<'s> {
    type Blocks = SolidBlocks<'s>;
    type Shape = Self;

    fn shape(&self) -> Self {
        *self
    }

    fn blocks(&self, order: &[u32]) -> Self::Blocks {
        SolidBlocks::new(*self, order)
    }

    fn bytes_of_blocks(slots: usize) -> u128 {
        slots as u128 * BYTES_OF_SLOT
    }
}
