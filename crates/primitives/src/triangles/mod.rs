//! Triangles as objects, with the kernel as a parameter.

mod bounds;
mod deferred;
mod edges;
mod frame;
mod immediate;
mod in_pairs;
mod in_place;
mod pack;
mod pairs;
mod pending;
mod resolve;
mod search;
#[cfg(test)]
mod tests;

pub use search::TriangleKernel;

use crate::Kernel;
use crate::kernel::{Packed, Preparation, Prepared, Storage};
use accel::Objects;
use accel::{Aabb, BuildError, Common, Corners, MeshRef, Nearest, Ray, Surface};
use bounds::TriangleBounds;
use edges::TileRays;
use frame::Frame;
use in_place::InPlace;
use lanes::packet::{NearestPacket, Packet, Pairs, Vec3Lanes};
use lanes::{BLOCK, Blocks, EMPTY_SLOT, Ids, PackedObjects, Shared, Tile};
use lanes::{ROW, Row, Simd};
use search::{Candidates, OneRay, PreparedSlot, Rays, Search, Slot};
use std::marker::PhantomData;

/// The triangles of a mesh, tested by kernel `K`.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'s, K: Kernel> {
    shape: TriangleBounds<'s, K::Storage>,
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
    pub fn new(mesh: impl Into<MeshRef<'s>>) -> Self {
        let mesh = mesh.into();
        let mut bounds = mesh.bounds();
        let storage = K::Storage::over(&bounds);
        if !bounds.is_empty() {
            bounds = Aabb { min: storage.place(bounds.min), max: storage.place(bounds.max) };
        }
        let frame = Frame::of(&bounds, K::NORMALISED);
        let shape = TriangleBounds { mesh, storage, hull: bounds, pad: frame.pad };
        Self { shape, frame, kernel: PhantomData }
    }

    /// The corners of a triangle, where the kernel sees them.
    #[inline]
    fn corners(&self, id: u32) -> Corners {
        self.shape.corners(id)
    }

    /// Whether `a` comes before `b`, both hit at the same reported t.
    #[inline]
    fn precedes(&self, ray: &Ray, a: u32, b: u32) -> bool {
        K::order(ray, || [self.corners(a), self.corners(b)]).then(a.cmp(&b)).is_lt()
    }
}

impl<'s, K: Kernel> Objects for Triangles<'s, K> {
    fn len(&self) -> usize {
        accel::Bounds::len(&self.shape)
    }

    #[inline(always)]
    fn bounds(&self, id: u32) -> Aabb {
        accel::Bounds::bounds(&self.shape, id)
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

impl<'s, K: TriangleKernel> PackedObjects for Triangles<'s, K> {
    type Blocks = TriangleBlocks<'s, K>;
    type Shape = TriangleBounds<'s, K::Storage>;

    fn shape(&self) -> Self::Shape {
        self.shape
    }

    fn blocks(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError> {
        pack::blocks(self, structure, order)
    }

    fn bytes_of_blocks(slots: usize) -> u128 {
        let slots = slots.next_multiple_of(lanes::BLOCK);
        let group = K::Storage::units::<K>() * size_of::<<K::Storage as Storage>::Unit>();
        (slots / ROW * group + slots * size_of::<u32>()) as u128
    }

    fn blocks_in_place(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError> {
        pack::blocks_in_place(self, structure, order)
    }
}

/// Triangles packed as rows of 16: four groups to a block.
#[derive(Clone, Debug)]
pub struct TriangleBlocks<'s, K: Kernel> {
    triangles: Triangles<'s, K>,
    units: Vec<<K::Storage as Storage>::Unit>,
    ids: Ids,
    /// Whether nothing is packed but numbers.
    in_place: bool,
}

/// Rows that hold the corners of triangles.
const CORNER_ROWS: usize = 9;

/// Scratch buffer for the rows of a group that have to be unpacked.
struct Scratch([Row; CORNER_ROWS]);

impl Scratch {
    const EMPTY: Self = Self([Row([0.0; ROW]); CORNER_ROWS]);
}

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// Prepares a ray.
    #[inline(always)]
    fn prepare_one(&self, ray: &Ray) -> TriangleRay<K::One> {
        let frame = &self.triangles.frame;
        // A ray without a range, as NaN makes it, has no certain hits.
        let near = frame.is_near(ray.origin) && ray.t_min <= ray.t_max;
        TriangleRay { prepared: K::one(&frame.ray(ray)), ray: *ray, near }
    }

    /// Prepares `LANES` rays.
    #[inline(always)]
    fn prepare_many<S: Simd>(&self, s: S, rays: &Packet<S>) -> Rays<K, S> {
        let prepared = K::many(s, &self.triangles.frame.packet(s, rays));
        TrianglePacket { prepared, rays: *rays, near: self.near(s, rays) }
    }

    /// The rays whose certain hits satisfy the invariant, see [`Frame::is_near`].
    #[inline(always)]
    fn near<S: Simd>(&self, s: S, rays: &Packet<S>) -> S::M {
        let frame = &self.triangles.frame;
        let near = s.splat(frame.near);
        let mut all = s.mask(u32::MAX);
        for axis in 0..3 {
            let distance = s.abs(s.sub(rays.origin[axis], s.splat(frame.center[axis])));
            all = s.and(all, s.le(distance, near));
        }
        s.and(all, s.le(rays.t_min, rays.t_max))
    }

    /// A slot's group as it is kept.
    #[inline(always)]
    fn units(&self, slot: usize) -> &[<K::Storage as Storage>::Unit] {
        let each = K::Storage::units::<K>();
        let first = slot / ROW * each;
        &self.units[first..first + each]
    }

    /// The triangles in `LANES` slots from `slot` on.
    #[inline(always)]
    fn unpacked<'a, S: Simd>(&'a self, s: S, slot: usize, rows: &'a mut [Row]) -> Packed<'a> {
        let (lane, Triangles { shape, frame, .. }) = (slot % ROW, &self.triangles);
        let at = lane / S::LANES * S::LANES;
        Packed::new(shape.storage.rows(s, self.units(slot), at, frame.scale, rows), lane)
    }

    /// The corners of the triangle in a slot, or others with the same box.
    #[inline(always)]
    fn corners(&self, packed: Packed<'_>, slot: usize) -> Corners {
        let corners = if self.rows_hold_corners() { K::corners(packed) } else { None };
        corners.unwrap_or_else(|| self.triangles.corners(self.ids.get(slot)))
    }

    /// [`TriangleBlocks::corners`] for one that isn't unpacked.
    #[inline(always)]
    fn corners_of(&self, slot: usize) -> Corners {
        if self.in_place {
            return self.triangles.corners(self.ids.get(slot));
        }
        match K::Storage::kept(self.units(slot)) {
            Some(group) => self.corners(Packed::new(group, slot % ROW), slot),
            None => self.triangles.corners(self.ids.get(slot)),
        }
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

impl<K: TriangleKernel> Blocks for TriangleBlocks<'_, K> {
    type One = OneRay<K>;
    type Many<S: Simd> = Rays<K, S>;

    fn bytes(&self) -> usize {
        accel::vec_bytes(&self.units) + self.ids.bytes()
    }

    #[inline]
    fn object(&self, slot: usize) -> u32 {
        self.ids.get(slot)
    }

    #[inline(always)]
    fn prefetch(&self, block: usize) {
        let each = BLOCK / ROW * K::Storage::units::<K>();
        lanes::prefetch(self.units.get(block * each..(block + 1) * each).unwrap_or_default());
    }

    #[inline(always)]
    fn one(&self, ray: &Ray) -> Self::One {
        self.prepare_one(ray)
    }

    #[inline(always)]
    fn many<S: Simd>(&self, s: S, rays: &Packet<S>) -> Self::Many<S> {
        self.prepare_many(s, rays)
    }

    #[inline(always)]
    fn closest<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, best: &mut Nearest) {
        if self.in_place {
            *best = InPlace::test(s, Candidates { blocks: self, block, mask }, ray.ray, false, *best);
            return;
        }
        K::Search::closest(s, Candidates { blocks: self, block, mask }, ray, best);
    }

    #[inline(always)]
    fn any<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, t_max: f32) -> bool {
        if self.in_place {
            let set = Candidates { blocks: self, block, mask };
            let best = InPlace::test(s, set, ray.ray, true, Nearest::new(t_max));
            return best.object != Nearest::NONE;
        }
        K::Search::any(s, Candidates { blocks: self, block, mask }, ray, t_max)
    }

    #[inline(always)]
    fn resolve(&self, ray: &Self::One, best: &mut Nearest) {
        K::Search::resolve(self, ray, best);
    }

    #[inline(always)]
    fn takes_pairs<S: Simd>() -> bool {
        K::Search::IN_PAIRS && S::LANES == ROW
    }

    #[inline(always)]
    fn pairs<S: Simd>(&self, s: S, pairs: &Pairs<'_, S>, best: &mut [Nearest; ROW]) {
        K::Search::pairs(self, s, pairs, best);
    }

    #[inline(always)]
    fn resolve_each<S: Simd>(&self, s: S, rays: &[Ray], best: &mut [Nearest]) {
        K::Search::resolve_each(self, s, rays, best);
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        if self.in_place {
            return self.packet_in_place(s, slot, rays, best);
        }
        K::Search::packet(s, Slot { blocks: self, slot }, rays, best);
    }

    const PREPARED_ROWS: usize = K::Preparation::ROWS + K::Search::LIMIT_ROWS + K::Storage::UNPACKED_ROWS;

    #[inline(always)]
    fn prepare<S: Simd>(&self, s: S, first: usize, common: &Common, rows: &mut [Row]) {
        let (rows, limits) = rows[..Self::PREPARED_ROWS].split_at_mut(K::Preparation::ROWS);
        let (limits, unpacked) = limits.split_at_mut(K::Search::LIMIT_ROWS);
        for at in (0..ROW).step_by(S::LANES) {
            let packed = self.unpacked(s, first + at, unpacked);
            K::Preparation::prepare(s, &self.triangles.frame.common(common), packed, rows);
            K::Search::limits(self, s, first + at, packed, limits);
        }
    }

    #[inline(always)]
    fn packet_prepared<S: Simd>(&self, s: S, at: Shared, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        let Shared { slot, common, rows } = at;
        let (rows, limits) = rows[..Self::PREPARED_ROWS].split_at(K::Preparation::ROWS);
        let (limits, unpacked) = limits.split_at(K::Search::LIMIT_ROWS);
        let packed = Packed::new(K::Storage::kept(self.units(slot)).unwrap_or(unpacked), slot % ROW);
        let common = &self.triangles.frame.common(common);
        let at = Slot { blocks: self, slot };
        let one = PreparedSlot { at, prepared: Prepared { common, packed, rows }, limits };
        K::Search::packet_prepared(s, one, rays, best);
    }

    const CULLING_ROWS: usize = if K::EDGE_ERROR.is_some() { edges::ROWS } else { 0 };

    #[inline(always)]
    fn prepare_culling<S: Simd>(&self, s: S, first: usize, tile: &Tile, rows: &mut [Row]) -> u32 {
        let Some(error) = K::EDGE_ERROR else { return u32::MAX };
        let mut culled = 0;
        let rays = TileRays::new(tile, self.triangles.frame.scale);
        let mut scratch = Scratch::EMPTY;
        for at in (0..ROW).step_by(S::LANES) {
            let corners = self.unpacked(s, first + at, &mut scratch.0).load_corners(s);
            culled |= s.bits(edges::prepare(s, &rays, error, corners, rows, at)) << at;
        }
        !culled
    }

    #[inline(always)]
    fn survivors<S: Simd>(s: S, rows: &[Row], middle: [f32; 2]) -> u32 {
        if K::EDGE_ERROR.is_some() { edges::survivors(s, rows, middle) } else { u32::MAX }
    }

    #[inline(always)]
    fn resolve_packet<S: Simd>(&self, s: S, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        K::Search::resolve_packet(self, s, rays, best);
    }
}
