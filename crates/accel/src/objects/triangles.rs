//! Triangles as objects, with the kernel as a parameter.

mod packets;
mod single;

use super::frame::{Frame, LIMIT_ROWS, Limits};
use super::ids::Ids;
use super::{BLOCK, Blocks, EMPTY_SLOT, Objects};
use crate::kernel::{Corners, Kernel, load_corners};
use crate::packet::{Common, NearestPacket, Packet, Vec3Lanes};
use crate::simd::{ROW, Row, Simd, prefetch};
use crate::{Aabb, Mesh, Nearest, Ray, Surface, filled};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::marker::PhantomData;

/// The triangles of a mesh, tested by kernel `K`.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'s, K> {
    mesh: &'s Mesh,
    frame: Frame,
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
    pub fn new(mesh: &'s Mesh) -> Self {
        Self { mesh, frame: Frame::of(mesh, K::NORMALISED), kernel: PhantomData }
    }

    /// The corners of a triangle.
    #[inline]
    fn corners(&self, id: u32) -> Corners {
        self.mesh.corners(id as usize)
    }

    /// Whether `a` comes before `b`, both hit at the same reported t.
    #[inline]
    fn precedes(&self, ray: &Ray, a: u32, b: u32) -> bool {
        let order = if K::ORDERS_TIES { self.order(ray, a, b) } else { Ordering::Equal };
        order.then(a.cmp(&b)).is_lt()
    }

    #[cold]
    fn order(&self, ray: &Ray, a: u32, b: u32) -> Ordering {
        K::order(ray, &self.corners(a), &self.corners(b))
    }
}

impl<'s, K: Kernel> Objects for Triangles<'s, K> {
    type Blocks = TriangleBlocks<'s, K>;

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
        frame.lawful(&corners, ray, frame.is_near(ray.origin), surface.t).then_some(surface)
    }

    #[inline]
    fn closest(&self, id: u32, ray: &Ray, best: &mut Nearest) {
        if let Some(surface) = self.intersect(id, ray, best.t) {
            best.offer_by(id, surface, |other| self.precedes(ray, id, other));
        }
    }

    fn blocks(&self, order: &[u32]) -> Self::Blocks {
        let groups = order.len().div_ceil(BLOCK) * (BLOCK / ROW);
        let mut rows = filled(Row([f32::NAN; ROW]), groups * K::ROWS);
        let mesh = self.mesh;
        let pack = |(group, rows): (usize, &mut [Row])| {
            // Triangles lie anywhere in memory, their corners anywhere else: both are asked for some groups ahead.
            let slots = |group: usize| order.iter().skip(group * ROW).take(ROW);
            for id in slots(group + 2 * AHEAD) {
                mesh.triangles.get(*id as usize).map(prefetch);
            }
            for id in slots(group + AHEAD) {
                for corner in mesh.triangles.get(*id as usize).into_iter().flatten() {
                    mesh.positions.get(*corner as usize).map(prefetch);
                }
            }
            for (lane, id) in slots(group).enumerate().filter(|(_, id)| **id != EMPTY_SLOT) {
                K::pack(&self.frame.corners(&self.corners(*id)), rows, lane);
            }
        };
        rows.par_chunks_exact_mut(K::ROWS).enumerate().with_min_len(512).for_each(pack);
        TriangleBlocks { triangles: *self, rows, ids: Ids::new(order) }
    }
}

/// Groups by which memory is asked for before it is needed; twice as many for what says where.
const AHEAD: usize = 2;

/// Triangles packed as rows of 16: four groups to a block.
#[derive(Clone, Debug)]
pub struct TriangleBlocks<'s, K> {
    triangles: Triangles<'s, K>,
    rows: Vec<Row>,
    ids: Ids,
}

impl<K: Kernel> TriangleBlocks<'_, K> {
    #[inline(always)]
    fn group(&self, slot: usize) -> &[Row] {
        let first = slot / ROW * K::ROWS;
        &self.rows[first..first + K::ROWS]
    }

    #[inline(always)]
    fn corners(&self, group: &[Row], slot: usize) -> Corners {
        let packed = if self.rows_hold_corners() { K::corners(group, slot % ROW) } else { None };
        packed.unwrap_or_else(|| self.triangles.corners(self.ids.get(slot)))
    }

    /// Whether the corners in the rows, if any, are those of the mesh.
    #[inline(always)]
    fn rows_hold_corners(&self) -> bool {
        self.triangles.frame.scale == 1.0
    }

    /// The corners of the triangles in `LANES` slots, where the rows don't hold them.
    #[inline(always)]
    fn gather<S: Simd>(&self, s: S, first: usize) -> [Vec3Lanes<S>; 3] {
        let mut rows = [[[f32::NAN; ROW]; 3]; 3];
        for lane in 0..S::LANES {
            let object = if first + lane < self.ids.len() { self.ids.get(first + lane) } else { EMPTY_SLOT };
            if object != EMPTY_SLOT {
                for (corner, rows) in self.triangles.corners(object).iter().zip(&mut rows) {
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
        crate::vec_bytes(&self.rows) + self.ids.bytes()
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
        if K::POSTPONES {
            return self.postpone_nearest(s, block, mask, ray, best);
        }
        self.visit(s, block, mask, ray, best.t, |object, surface| {
            self.offer_one(ray, object, surface, best);
            Some(best.t)
        });
    }

    #[inline(always)]
    fn any<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, t_max: f32) -> bool {
        if K::POSTPONES {
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
    fn settle(&self, ray: &Self::One, best: &mut Nearest) {
        if K::POSTPONES {
            self.settle_one(ray, best);
        }
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        let group = self.group(slot);
        if K::POSTPONES {
            let bounds = K::bounds(s, &rays.prepared, group, slot % ROW, best.t);
            if s.bits(bounds.open) != 0 {
                self.postpone(s, slot, rays, &bounds, best);
            }
            return;
        }
        let lanes = K::rays(s, &rays.prepared, group, slot % ROW, best.t);
        if s.bits(lanes.hit) != 0 {
            let limits = Limits::of(&self.triangles.frame, &self.corners(group, slot));
            self.offer(s, slot, rays, &limits, lanes, best);
        }
    }

    const PREPARED_ROWS: usize = K::PREPARED_ROWS + if K::POSTPONES { 0 } else { LIMIT_ROWS };

    #[inline(always)]
    fn prepare<S: Simd>(&self, s: S, first: usize, common: &Common, rows: &mut [Row]) {
        let group = self.group(first);
        let (rows, limits) = rows[..Self::PREPARED_ROWS].split_at_mut(K::PREPARED_ROWS);
        for at in (0..ROW).step_by(S::LANES) {
            K::prepare(s, &self.triangles.frame.common(common), group, at, rows);
            if K::POSTPONES {
                continue;
            }
            let corners = if self.rows_hold_corners() && K::corners(group, 0).is_some() {
                load_corners(s, group, at)
            } else {
                self.gather(s, first + at)
            };
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
        let group = self.group(slot);
        let lane = slot % ROW;
        let (rows, limits) = rows[..Self::PREPARED_ROWS].split_at(K::PREPARED_ROWS);
        let common = &self.triangles.frame.common(common);
        if K::POSTPONES {
            let bounds = K::bounds_prepared(s, &rays.prepared, common, group, rows, lane, best.t);
            if s.bits(bounds.open) != 0 {
                self.postpone(s, slot, rays, &bounds, best);
            }
            return;
        }
        let lanes = K::rays_prepared(s, &rays.prepared, common, group, rows, lane, best.t);
        if s.bits(lanes.hit) != 0 {
            self.offer(s, slot, rays, &Limits::load(limits, lane), lanes, best);
        }
    }

    #[inline(always)]
    fn settle_packet<S: Simd>(&self, s: S, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        if K::POSTPONES {
            self.settle_lanes(s, rays, u32::MAX, best);
        }
    }
}
