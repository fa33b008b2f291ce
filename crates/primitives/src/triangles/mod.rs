//! Triangles as objects, with the kernel as a parameter.

mod frame;
mod in_place;
mod lattice;
mod pack;
mod packets;
mod pairs;
mod pending;
mod single;
#[cfg(test)]
mod tests;

use self::frame::{Frame, LIMIT_ROWS, Limits};
use self::lattice::{Lattice, ShortRows};
use crate::Kernel;
use crate::kernel::load_corners;
use crate::kernel::{Deferral, Preparation};
use accel::Objects;
use accel::{Aabb, Common, Corners, MeshRef, Nearest, Ray, Surface};
use lanes::packet::{NearestPacket, Packet, Pairs, Vec3Lanes};
use lanes::{Blocks, EMPTY_SLOT, Ids, PackedObjects};
use lanes::{ROW, Row, Simd};
use std::cmp::Ordering;
use std::marker::PhantomData;

/// The triangles of a mesh, tested by kernel `K`.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'s, K> {
    mesh: MeshRef<'s>,
    frame: Frame,
    /// For kernels that are [`Kernel::QUANTISED`].
    lattice: Lattice,
    kernel: PhantomData<K>,
}

/// A ray prepared for triangles.
#[derive(Clone, Copy, Debug)]
pub struct TriangleRay<P> {
    prepared: P,
    ray: Ray,
    near: bool,
}

/// A packet of rays prepared for triangles.
#[derive(Clone, Copy)]
pub struct TrianglePacket<S: Simd, P> {
    prepared: P,
    rays: Packet<S>,
    near: S::M,
}

impl<'s, K: Kernel> Triangles<'s, K> {
    /// The objects of a scene of triangles.
    pub fn new(mesh: impl Into<MeshRef<'s>>) -> Self {
        let mesh = mesh.into();
        const { assert!(!K::QUANTISED || (K::ROWS == CORNER_ROWS && !K::Deferral::DEFERS)) };
        let mut bounds = mesh.bounds();
        let lattice = Lattice::over(&bounds);
        if K::QUANTISED && !bounds.is_empty() {
            bounds = Aabb { min: lattice.snap(bounds.min), max: lattice.snap(bounds.max) };
        }
        Self { mesh, frame: Frame::of(&bounds, K::NORMALISED), lattice, kernel: PhantomData }
    }

    /// The corners of a triangle, where the kernel sees them.
    #[inline]
    fn corners(&self, id: u32) -> Corners {
        let corners = self.mesh.corners(id as usize);
        if K::QUANTISED { corners.map(|corner| self.lattice.snap(corner)) } else { corners }
    }

    /// Whether `a` comes before `b`, both hit at the same reported t.
    #[inline]
    fn precedes(&self, ray: &Ray, a: u32, b: u32) -> bool {
        let order = if K::Deferral::DEFERS { self.order(ray, a, b) } else { Ordering::Equal };
        order.then(a.cmp(&b)).is_lt()
    }

    #[cold]
    fn order(&self, ray: &Ray, a: u32, b: u32) -> Ordering {
        K::Deferral::order(ray, &self.corners(a), &self.corners(b))
    }
}

impl<'s, K: Kernel> Objects for Triangles<'s, K> {
    fn len(&self) -> usize {
        self.mesh.triangles.len()
    }

    #[inline(always)]
    fn bounds(&self, id: u32) -> Aabb {
        let [a, b, c] = self.corners(id);
        Aabb { min: a.min(b).min(c), max: a.max(b).max(c) }.padded(self.frame.pad)
    }

    #[inline]
    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface> {
        let corners = self.corners(id);
        let frame = &self.frame;
        let surface = K::test(&K::one(&frame.ray(ray)), &frame.corners(&corners), t_max)?;
        frame.holds(&corners, ray, frame.is_near(ray.origin), surface.t).then_some(surface)
    }

    #[inline]
    fn closest(&self, id: u32, ray: &Ray, best: &mut Nearest) {
        if let Some(surface) = self.intersect(id, ray, best.t) {
            best.offer_by(id, surface, |other| self.precedes(ray, id, other));
        }
    }
}

impl<'s, K: Kernel> PackedObjects for Triangles<'s, K> {
    type Blocks = TriangleBlocks<'s, K>;

    fn blocks(&self, order: &[u32]) -> Self::Blocks {
        pack::blocks(self, order)
    }

    fn blocks_in_place(&self, order: &[u32]) -> Self::Blocks {
        pack::blocks_in_place(self, order)
    }
}

/// Triangles packed as rows of 16: four groups to a block.
#[derive(Clone, Debug)]
pub struct TriangleBlocks<'s, K> {
    triangles: Triangles<'s, K>,
    /// What the kernel packs, unless it is [`Kernel::QUANTISED`].
    rows: Vec<Row>,
    /// The corners of those that are.
    short: Vec<ShortRows>,
    ids: Ids,
    /// Whether nothing is packed but numbers.
    in_place: bool,
}

/// The lowest bit as a lane, taken off.
#[inline(always)]
fn next_lane(bits: &mut u32) -> Option<usize> {
    let lane = bits.trailing_zeros() as usize;
    *bits &= bits.wrapping_sub(1);
    (lane < ROW).then_some(lane)
}

/// Rows that hold the corners of triangles.
const CORNER_ROWS: usize = 9;

/// Scratch buffer for the rows of a group that have to be unpacked.
struct Scratch([Row; CORNER_ROWS]);

impl Scratch {
    const EMPTY: Self = Self([Row([0.0; ROW]); CORNER_ROWS]);
}

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// The rows of a slot's group as packed.
    #[inline(always)]
    fn packed(&self, slot: usize) -> &[Row] {
        let first = slot / ROW * K::ROWS;
        &self.rows[first..first + K::ROWS]
    }

    /// The rows of a slot's group, in which the lanes `LANES` by `LANES` with that of the slot are unpacked.
    #[inline(always)]
    fn group<'a, S: Simd>(&'a self, s: S, slot: usize, scratch: &'a mut Scratch) -> &'a [Row] {
        if K::QUANTISED {
            self.unpack(s, slot, slot % ROW / S::LANES * S::LANES, &mut scratch.0);
            return &scratch.0;
        }
        self.packed(slot)
    }

    /// Unpacks `LANES` triangles of a slot's group.
    #[inline(always)]
    fn unpack<S: Simd>(&self, s: S, slot: usize, at: usize, rows: &mut [Row]) {
        let Triangles { lattice, frame, .. } = &self.triangles;
        lattice.unpack(s, &self.short[slot / ROW], at, frame.scale, rows);
    }

    /// The corners of the triangle in a slot, or others with the same box.
    #[inline(always)]
    fn corners(&self, group: &[Row], slot: usize) -> Corners {
        let packed = if self.rows_hold_corners() { K::corners(group, slot % ROW) } else { None };
        packed.unwrap_or_else(|| self.triangles.corners(self.ids.get(slot)))
    }

    /// [`TriangleBlocks::corners`] for one that isn't unpacked.
    #[inline(always)]
    fn corners_of(&self, slot: usize) -> Corners {
        if K::QUANTISED {
            return self.triangles.corners(self.ids.get(slot));
        }
        self.corners(self.packed(slot), slot)
    }

    /// Whether the corners in the rows, if any, are those of the mesh.
    #[inline(always)]
    fn rows_hold_corners(&self) -> bool {
        self.triangles.frame.scale == 1.0
    }

    /// The corners of the triangles in `LANES` slots, where the rows don't hold all nine.
    #[inline(always)]
    fn gather<S: Simd>(&self, s: S, first: usize) -> [Vec3Lanes<S>; 3] {
        let mut rows = [[[f32::NAN; ROW]; 3]; 3];
        for lane in 0..S::LANES {
            let object = if first + lane < self.ids.len() { self.ids.get(first + lane) } else { EMPTY_SLOT };
            if object != EMPTY_SLOT {
                for (corner, rows) in self.corners_of(first + lane).iter().zip(&mut rows) {
                    (rows[0][lane], rows[1][lane], rows[2][lane]) = (corner.x, corner.y, corner.z);
                }
            }
        }
        rows.map(|corner| corner.map(|row| s.load(&row)))
    }
}

impl<K: Kernel> Blocks for TriangleBlocks<'_, K> {
    type One = TriangleRay<K::One>;
    type Many<S: Simd> = TrianglePacket<S, K::Many<S>>;

    fn bytes(&self) -> usize {
        accel::vec_bytes(&self.rows) + accel::vec_bytes(&self.short) + self.ids.bytes()
    }

    #[inline]
    fn object(&self, slot: usize) -> u32 {
        self.ids.get(slot)
    }

    #[inline(always)]
    fn one(&self, ray: &Ray) -> Self::One {
        let frame = &self.triangles.frame;
        TriangleRay { prepared: K::one(&frame.ray(ray)), ray: *ray, near: frame.is_near(ray.origin) }
    }

    #[inline(always)]
    fn many<S: Simd>(&self, s: S, rays: &Packet<S>) -> Self::Many<S> {
        let frame = &self.triangles.frame;
        let near = s.splat(frame.near);
        let mut all = s.mask(u32::MAX);
        for axis in 0..3 {
            let distance = s.abs(s.sub(rays.origin[axis], s.splat(frame.center[axis])));
            all = s.and(all, s.le(distance, near));
        }
        TrianglePacket { prepared: K::many(s, &frame.packet(s, rays)), rays: *rays, near: all }
    }

    #[inline(always)]
    fn closest<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, best: &mut Nearest) {
        if self.in_place {
            return self.one_in_place(s, block, mask, &ray.ray, false, best);
        }
        if K::Deferral::DEFERS {
            return self.defer_nearest(s, block, mask, ray, best);
        }
        self.visit(s, block, mask, ray, best.t, |object, surface| {
            self.offer_one(ray, object, surface, best);
            Some(best.t)
        });
    }

    #[inline(always)]
    fn any<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, t_max: f32) -> bool {
        if self.in_place {
            let mut best = Nearest::new(t_max);
            self.one_in_place(s, block, mask, &ray.ray, true, &mut best);
            return best.object != Nearest::NONE;
        }
        if K::Deferral::DEFERS {
            return self.any_certain(s, block, mask, ray, t_max);
        }
        let mut any = false;
        self.visit(s, block, mask, ray, t_max, |_, _| {
            any = true;
            None
        });
        any
    }

    #[inline(always)]
    fn resolve(&self, ray: &Self::One, best: &mut Nearest) {
        if K::Deferral::DEFERS {
            self.resolve_one(ray, best);
        }
    }

    #[inline(always)]
    fn takes_pairs<S: Simd>() -> bool {
        K::EACH && S::LANES == ROW
    }

    #[inline(always)]
    fn pairs<S: Simd>(
        &self,
        s: S,
        block: usize,
        pairs: &Pairs,
        lanes: &Packet<S>,
        any: bool,
        best: &mut [Nearest; ROW],
    ) {
        if !K::EACH {
            return self.pairs_one_by_one(s, block, pairs, lanes, best);
        }
        if self.in_place {
            return self.pairs_in_place(s, block, pairs, lanes, any, best);
        }
        self.each_pair(s, block, pairs, lanes, any, best);
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        if self.in_place {
            return self.packet_in_place(s, slot, &rays.rays, best);
        }
        let mut scratch = Scratch::EMPTY;
        let group = self.group(s, slot, &mut scratch);
        if K::Deferral::DEFERS {
            let bounds = K::Deferral::bounds(s, &rays.prepared, group, slot % ROW, best.t);
            if s.bits(bounds.undecided) != 0 {
                self.defer(s, slot, rays, &bounds, best);
            }
            return;
        }
        let lanes = K::rays(s, &rays.prepared, group, slot % ROW, best.t);
        if s.bits(lanes.hit) != 0 {
            let limits = Limits::of(&self.triangles.frame, &self.corners(group, slot));
            self.offer(s, slot, rays, &limits, lanes, best);
        }
    }

    const PREPARED_ROWS: usize = K::Prepared::ROWS
        + if K::Deferral::DEFERS { 0 } else { LIMIT_ROWS }
        + if K::QUANTISED { CORNER_ROWS } else { 0 };

    #[inline(always)]
    fn prepare<S: Simd>(&self, s: S, first: usize, common: &Common, rows: &mut [Row]) {
        let (rows, limits) = rows[..Self::PREPARED_ROWS].split_at_mut(K::Prepared::ROWS);
        let (limits, unpacked) = limits.split_at_mut(if K::Deferral::DEFERS { 0 } else { LIMIT_ROWS });
        for at in (0..ROW).step_by(S::LANES) {
            let group = if K::QUANTISED {
                self.unpack(s, first, at, unpacked);
                &*unpacked
            } else {
                self.packed(first)
            };
            K::Prepared::prepare(s, &self.triangles.frame.common(common), group, at, rows);
            if K::Deferral::DEFERS {
                continue;
            }
            let held = K::ROWS >= CORNER_ROWS && self.rows_hold_corners() && K::corners(group, 0).is_some();
            let corners = if held { load_corners(s, group, at) } else { self.gather(s, first + at) };
            Limits::store(s, &self.triangles.frame, corners, limits, at);
        }
    }

    #[inline(always)]
    fn packet_prepared<S: Simd>(
        &self,
        s: S,
        slot: usize,
        common: &Common,
        rows: &[Row],
        rays: &Self::Many<S>,
        best: &mut NearestPacket<S>,
    ) {
        let lane = slot % ROW;
        let (rows, limits) = rows[..Self::PREPARED_ROWS].split_at(K::Prepared::ROWS);
        let group = if K::QUANTISED { &limits[LIMIT_ROWS..] } else { self.packed(slot) };
        let common = &self.triangles.frame.common(common);
        if K::Deferral::DEFERS {
            let bounds = K::Deferral::bounds_prepared(s, &rays.prepared, common, group, rows, lane, best.t);
            if s.bits(bounds.undecided) != 0 {
                self.defer(s, slot, rays, &bounds, best);
            }
            return;
        }
        let lanes = K::Prepared::rays_prepared(s, &rays.prepared, common, group, rows, lane, best.t);
        if s.bits(lanes.hit) != 0 {
            self.offer(s, slot, rays, &Limits::load(limits, lane), lanes, best);
        }
    }

    #[inline(always)]
    fn resolve_packet<S: Simd>(&self, s: S, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        if K::Deferral::DEFERS {
            self.resolve_lanes(s, rays, u32::MAX, best);
        }
    }
}
