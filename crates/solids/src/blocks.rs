//! Solids packed in blocks of 64: kinds that have rows are tested `LANES` at a time, others one by one.

use crate::frame::Frame;
use crate::group::{Kind, Part, Slot};
use crate::objects::{Precision, Solids};
use crate::rows::{Cones, Packing, Prepared, Spheres, Triangles, load, splat};
use accel::{BuildError, Nearest, Objects, Ray};
use lanes::packet::{NearestPacket, Packet, Pairs, RayRows};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, Ids, PackedObjects, ROW, Scalar, Simd, next_lane, one_by_one};

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
    pub fn new(solids: Solids<'s>, structure: &str, order: &[u32]) -> Result<Self, BuildError> {
        let spheres = Kind::new(&solids, structure, order)?;
        let cones = Kind::new(&solids, structure, order)?;
        let triangles = Kind::new(&solids, structure, order)?;
        Ok(Self { solids, ids: Ids::new(structure, order)?, spheres, cones, triangles })
    }

    fn frame(&self) -> &Frame {
        &self.solids.frame
    }

    pub(crate) fn is_exact(&self) -> bool {
        self.solids.precision() == Precision::Exact
    }

    #[inline(always)]
    fn one_by_one(&self, first: usize, mut mask: u32, ray: &Ray, best: &mut Nearest) {
        while let Some(lane) = next_lane(&mut mask) {
            let object = self.ids.get(first + lane);
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
        for part in group.parts::<S>(number * ROW, wanted) {
            self.part::<K, S>(s, &part, ray, best);
        }
        group.mask
    }

    #[inline(always)]
    fn part<K: Packing, S: Simd>(&self, s: S, part: &Part<'_>, ray: &OneRay, best: &mut Nearest) {
        let values = load::<K, S>(s, part.rows, part.lane);
        let found = K::test(s, &ray.prepared.splat(s), &values, s.splat(best.t));
        let mut hits = s.bits(found.lanes.hit) & part.wanted;
        if hits == 0 {
            return;
        }
        let plain = s.bits(found.plain);
        let rows = found.lanes.rows(s);
        while let Some(at) = next_lane(&mut hits) {
            let (object, t) = (self.ids.get(part.slot + at), rows.t[at]);
            if precedes(t, object, best) && (plain >> at & 1 != 0 || self.solids.holds(object, &ray.ray, t)) {
                best.offer(object, rows.surface(at));
            }
        }
    }

    /// One packed object against the near ones of `LANES` rays.
    #[inline(always)]
    fn packed<K: Packing, S: Simd>(
        &self,
        s: S,
        slot: Slot<'_>,
        rays: &ManyRays<S>,
        best: &mut NearestPacket<S>,
    ) {
        let object = self.ids.get(slot.slot);
        let values = splat::<K, S>(s, slot.rows, slot.lane());
        let found = K::test(s, &rays.prepared, &values, best.t);
        let mut lanes = found.lanes;
        lanes.hit = s.and(lanes.hit, rays.near);
        let unsure = s.bits(lanes.hit) & !s.bits(found.plain);
        if unsure != 0 {
            let beside = self.beside(object, unsure, &RayRows::of(s, &rays.rays), &lanes.rows(s).t);
            lanes.hit = s.mask(s.bits(lanes.hit) & !beside);
        }
        best.offer(s, object, &lanes);
    }

    /// The `unsure` lanes whose hits don't satisfy the hit-in-padded-bounds invariant.
    pub(crate) fn beside(&self, object: u32, mut unsure: u32, rays: &RayRows, t: &[f32; ROW]) -> u32 {
        let mut beside = 0;
        while let Some(lane) = next_lane(&mut unsure) {
            beside |= u32::from(!self.solids.holds(object, &rays.ray(lane), t[lane])) << lane;
        }
        beside
    }
}

/// Whether a hit comes before the nearest so far.
#[inline(always)]
pub(crate) fn precedes(t: f32, object: u32, best: &Nearest) -> bool {
    t < best.t || (t == best.t && object < best.object)
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
                for part in spheres.parts::<S>(first, wanted) {
                    match self.is_exact() {
                        true => self.exact_part(s, &part, ray, best),
                        false => self.part::<Spheres, S>(s, &part, ray, best),
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
        let all = u32::MAX >> (32 - S::LANES);
        let mut left = all & !s.bits(rays.near);
        if let Some(sphere) = self.spheres.slot(slot) {
            match self.is_exact() {
                true => self.exact_packed(s, sphere, rays, best),
                false => self.packed::<Spheres, S>(s, sphere, rays, best),
            }
        } else if let Some(cone) = self.cones.slot(slot) {
            self.packed::<Cones, S>(s, cone, rays, best);
        } else if let Some(triangle) = self.triangles.slot(slot) {
            self.packed::<Triangles, S>(s, triangle, rays, best);
        } else {
            left = all;
        }
        let object = self.ids.get(slot);
        if left != 0 && object != EMPTY_SLOT {
            one_by_one(s, (&self.solids, object), left, &rays.rays, best);
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

    fn blocks(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError> {
        SolidBlocks::new(*self, structure, order)
    }

    fn bytes_of_blocks(slots: usize) -> u128 {
        slots as u128 * BYTES_OF_SLOT
    }
}
