//! Triangles as objects, with the kernel as a parameter.

use super::frame::{Frame, plainly_lawful};
use super::ids::Ids;
use super::{BLOCK, Blocks, EMPTY_SLOT, Objects};
use crate::kernel::{Corners, Kernel, load_corners, store_rows, sub3};
use crate::packet::{Common, Lanes, NearestPacket, Packet, Vec3Lanes};
use crate::simd::{ROW, Row, Simd};
use crate::{Aabb, Mesh, Nearest, Ray, Surface};
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
        let mut rows = vec![Row([f32::NAN; ROW]); groups * K::ROWS];
        let pack = |(group, ids): (&mut [Row], &[u32])| {
            for (lane, id) in ids.iter().enumerate().filter(|(_, id)| **id != EMPTY_SLOT) {
                K::pack(&self.frame.corners(&self.corners(*id)), group, lane);
            }
        };
        rows.par_chunks_exact_mut(K::ROWS).zip(order.par_chunks(ROW)).with_min_len(512).for_each(pack);
        TriangleBlocks { triangles: *self, rows, ids: Ids::new(order) }
    }
}

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

    /// Decides the lanes that hit `object` at the same t as another object, and strikes them off `lanes`.
    #[inline(always)]
    fn take_ties<S: Simd>(
        &self,
        s: S,
        object: u32,
        lanes: &mut Lanes<S>,
        rays: &Packet<S>,
        best: &mut NearestPacket<S>,
    ) {
        let mut ties = s.bits(best.ties(s, object, lanes));
        if ties == 0 {
            return;
        }
        let settled = s.bits(lanes.hit) & !ties;
        let mut others = [Nearest::new(0.0); ROW];
        best.store(s, &mut others);
        let mut wins = 0;
        while ties != 0 {
            let lane = ties.trailing_zeros() as usize;
            ties &= ties - 1;
            let wins_here = self.triangles.precedes(&rays.ray(s, lane), object, others[lane].object);
            wins |= u32::from(wins_here) << lane;
        }
        best.take(s, s.mask(wins), object, lanes);
        lanes.hit = s.mask(settled);
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

    /// Offers those lanes of `hits` that keep the law: those in `plain` whose origins are near, and
    /// those of the others that the full test finds lawful.
    #[inline(always)]
    fn offer<S: Simd>(
        &self,
        s: S,
        slot: usize,
        rays: &TrianglePacket<S, K::Many<S>>,
        plain: S::M,
        mut lanes: Lanes<S>,
        best: &mut NearestPacket<S>,
    ) {
        let hits = s.bits(lanes.hit);
        let plain = s.bits(s.and(rays.near, plain));
        let mut open = hits & !plain;
        if open != 0 {
            let corners = self.corners(self.group(slot), slot);
            let mut lawful = hits & plain;
            let rows = lanes.rows(s);
            while open != 0 {
                let lane = open.trailing_zeros() as usize;
                open &= open - 1;
                if self.triangles.frame.lawful(&corners, &rays.rays.ray(s, lane), false, rows.surface(lane).t)
                {
                    lawful |= 1 << lane;
                }
            }
            lanes.hit = s.mask(lawful);
        }
        let object = self.ids.get(slot);
        if K::ORDERS_TIES {
            self.take_ties(s, object, &mut lanes, &rays.rays, best);
        }
        best.offer(s, object, &lanes);
    }

    /// Calls `found` with every lawful hit among the set bits until it says to stop.
    #[inline(always)]
    fn visit<S: Simd>(
        &self,
        s: S,
        block: usize,
        mut mask: u64,
        ray: &TriangleRay<K::One>,
        mut t_max: f32,
        mut found: impl FnMut(u32, Surface) -> Option<f32>,
    ) {
        let lanes_mask = u64::MAX >> (64 - S::LANES);
        while mask != 0 {
            let first = mask.trailing_zeros() as usize / S::LANES * S::LANES;
            let wanted = (mask >> first & lanes_mask) as u32;
            mask &= !(lanes_mask << first);
            let group = self.group(block * BLOCK + first);
            let lanes = K::triangles(s, &ray.prepared, group, first % ROW, wanted, t_max);
            let mut hits = s.bits(lanes.hit) & wanted;
            if hits == 0 {
                continue;
            }
            let rows = lanes.rows(s);
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize;
                hits &= hits - 1;
                let slot = block * BLOCK + first + lane;
                let surface = rows.surface(lane);
                let corners = self.corners(group, slot);
                if self.triangles.frame.lawful(&corners, &ray.ray, ray.near, surface.t) {
                    match found(self.ids.get(slot), surface) {
                        Some(limit) => t_max = limit,
                        None => return,
                    }
                }
            }
        }
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
        self.visit(s, block, mask, ray, best.t, |object, surface| {
            best.offer_by(object, surface, |other| self.triangles.precedes(&ray.ray, object, other));
            Some(best.t)
        });
    }

    #[inline(always)]
    fn any<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, t_max: f32) -> bool {
        let mut any = false;
        self.visit(s, block, mask, ray, t_max, |_, _| {
            any = true;
            None
        });
        any
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        let group = self.group(slot);
        let lanes = K::rays(s, &rays.prepared, group, slot % ROW, best.t);
        if s.bits(lanes.hit) == 0 {
            return;
        }
        let corners = self.corners(group, slot);
        let plain = plainly_lawful(s, &self.triangles.frame, &corners, &rays.rays, lanes.t);
        self.offer(s, slot, rays, plain, lanes, best);
    }

    const PREPARED_ROWS: usize = K::PREPARED_ROWS + LIMIT_ROWS;

    #[inline(always)]
    fn prepare<S: Simd>(&self, s: S, first: usize, common: &Common, rows: &mut [Row]) {
        let group = self.group(first);
        let (limits, rows) = rows[..Self::PREPARED_ROWS].split_at_mut(LIMIT_ROWS);
        let half = s.splat(self.triangles.frame.pad * 0.5);
        for at in (0..ROW).step_by(S::LANES) {
            K::prepare(s, &self.triangles.frame.common(common), group, at, rows);
            let [a, b, c] = if self.rows_hold_corners() && K::corners(group, 0).is_some() {
                load_corners(s, group, at)
            } else {
                self.gather(s, first + at)
            };
            let (edge1, edge2) = (sub3(s, b, a), sub3(s, c, a));
            let zero = s.splat(0.0);
            let (mut low, mut high) = (edge1, edge1);
            for axis in 0..3 {
                low[axis] = s.sub(s.min(s.min(edge1[axis], edge2[axis]), zero), half);
                high[axis] = s.add(s.max(s.max(edge1[axis], edge2[axis]), zero), half);
            }
            store_rows(s, a, &mut limits[0..3], at);
            store_rows(s, low, &mut limits[3..6], at);
            store_rows(s, high, &mut limits[6..9], at);
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
        let (limits, rows) = rows[..Self::PREPARED_ROWS].split_at(LIMIT_ROWS);
        let common = &self.triangles.frame.common(common);
        let lanes = K::rays_prepared(s, &rays.prepared, common, group, rows, lane, best.t);
        if s.bits(lanes.hit) == 0 {
            return;
        }
        let mut plain = s.mask(u32::MAX);
        for axis in 0..3 {
            let [a, low, high] = [limits[axis].0[lane], limits[3 + axis].0[lane], limits[6 + axis].0[lane]];
            let from_a = s.sub(rays.rays.origin[axis], s.splat(a));
            let position = s.add(from_a, s.mul(rays.rays.direction[axis], lanes.t));
            plain = s.and(plain, s.and(s.le(s.splat(low), position), s.le(position, s.splat(high))));
        }
        self.offer(s, slot, rays, plain, lanes, best);
    }
}

/// Rows that hold each triangle's first corner and the limits of [`Frame::plainly_lawful`].
const LIMIT_ROWS: usize = 9;
