//! Rays and packed triangles brought together, one of each in a lane.

use super::pending::load_nearest;
use super::{CORNER_ROWS, TriangleBlocks};
use crate::kernel::{Floats, Kernel, Many, Permuted};
use accel::{MeshRef, Nearest, Ray};
use lanes::packet::{Packet, Pairs, RayRows, Vec3Lanes};
use lanes::{BLOCK, EMPTY_SLOT, ROW, Row, Simd, next_bit};

/// The rays of pairs, prepared.
pub(super) struct PairRays<K: Kernel, S: Simd> {
    many: Many<K, S>,
    rows: RayRows,
    /// Up to what t each looks.
    t_max: [f32; ROW],
}

/// `LANES` of the pairs, or those that are left.
pub(super) struct Group<'a, K: Kernel, S: Simd> {
    /// The ray of each lane.
    pub rays: Many<K, S>,
    /// Up to what t it looks.
    pub t_max: S::F,
    /// The corners of each lane's triangle as the kernel sees them.
    pub corners: [Vec3Lanes<S>; 3],
    /// A bit for each lane that holds a pair.
    pub wanted: u32,
    lanes: Lanes<'a>,
}

/// What is in each lane.
struct Lanes<'a> {
    /// The ray, by its place in the packet.
    places: &'a [u8],
    /// The triangle, by its slot in the block.
    slots: &'a [u8],
    /// The first slot of the block.
    first: usize,
    /// How many pairs there are.
    len: usize,
}

impl<K: Permuted<Storage = Floats>, S: Simd> PairRays<K, S> {
    /// Prepares the rays; each looks up to its nearest hit so far.
    #[inline(always)]
    pub fn of(s: S, blocks: &TriangleBlocks<K>, pairs: &Pairs<S>, best: &[Nearest; ROW]) -> Self {
        let mut t_max = [0.0; ROW];
        for at in (0..ROW).step_by(S::LANES) {
            let [t, ..] = load_nearest(s, &best[at..]);
            s.store(t, &mut t_max[at..]);
        }
        let many = K::many(s, &blocks.triangles.frame.packet(s, pairs.packet));
        Self { many, rows: RayRows::of(s, pairs.packet), t_max }
    }

    /// The pairs from `at` on, ray and triangle in one lane.
    #[inline(always)]
    pub fn group<'a>(
        &self,
        s: S,
        blocks: &TriangleBlocks<K>,
        pairs: &Pairs<'a, S>,
        at: usize,
    ) -> Group<'a, K, S> {
        let (places, slots) = (&pairs.rays[at..], &pairs.slots[at..]);
        let lanes = Lanes { places, slots, first: pairs.block * BLOCK, len: S::LANES.min(pairs.len - at) };
        let ray = s.load_bytes(places);
        Group {
            rays: K::permuted(s, &self.many, ray),
            t_max: s.permute(s.load(&self.t_max), ray),
            corners: blocks.corners_each(s, pairs.block, &lanes),
            wanted: u32::MAX >> (32 - lanes.len),
            lanes,
        }
    }

    /// The ray at a place.
    #[inline(always)]
    pub fn ray(&self, place: usize) -> Ray {
        self.rows.ray(place)
    }

    /// Up to what t the ray at a place looks.
    #[inline(always)]
    pub fn t_max(&self, place: usize) -> f32 {
        self.t_max[place]
    }

    /// Lets the ray at a place look no farther than a hit, or no more if any hit will do.
    #[inline(always)]
    pub fn found(&mut self, place: usize, any: bool, t: f32) {
        self.t_max[place] = if any { f32::NEG_INFINITY } else { t };
    }
}

impl<K: Kernel, S: Simd> Group<'_, K, S> {
    /// The ray of each lane, as it was given.
    #[inline(always)]
    pub fn packet(&self, s: S, pairs: &Pairs<S>) -> Packet<S> {
        pairs.packet.permuted(s, s.load_bytes(self.lanes.places))
    }

    /// The slot of a lane's triangle and the place of its ray.
    #[inline(always)]
    pub fn pair(&self, lane: usize) -> (usize, usize) {
        (self.lanes.slot(lane), usize::from(self.lanes.places[lane]) % ROW)
    }
}

impl<K: Kernel<Storage = Floats>, S: Simd> Group<'_, K, S> {
    /// What is packed in a row, of each lane's triangle.
    #[inline(always)]
    pub fn row(&self, s: S, blocks: &TriangleBlocks<K>, block: usize, row: usize) -> S::F {
        look_up(s, blocks.rows(block), K::ROWS, row, s.load_bytes(self.lanes.slots))
    }
}

/// What a row of each of the four groups of a block, of `rows` rows each, holds in these slots.
#[inline(always)]
fn look_up<S: Simd>(s: S, packed: &[Row], rows: usize, row: usize, slot: S::U) -> S::F {
    let at = &packed[row..];
    s.lookup([&at[0], &at[rows], &at[2 * rows], &at[3 * rows]], slot)
}

impl Lanes<'_> {
    #[inline(always)]
    fn slot(&self, lane: usize) -> usize {
        self.first + usize::from(self.slots[lane])
    }
}

impl<K: Kernel<Storage = Floats>> TriangleBlocks<'_, K> {
    /// The corners of each lane's triangle as the kernel sees them.
    #[inline(always)]
    fn corners_each<S: Simd>(&self, s: S, block: usize, lanes: &Lanes) -> [Vec3Lanes<S>; 3] {
        if self.in_place {
            return self.corners_in_place(s, &self.ids_of(lanes));
        }
        let (slot, packed) = (s.load_bytes(lanes.slots), self.rows(block));
        let mut corners = [[s.splat(0.0); 3]; 3];
        for (corner, values) in corners.iter_mut().enumerate() {
            for (axis, value) in values.iter_mut().enumerate() {
                const { assert!(K::ROWS >= CORNER_ROWS, "the kernel packs corners") };
                *value = look_up(s, packed, K::ROWS, 3 * corner + axis, slot);
            }
        }
        corners
    }

    /// The rows of a block.
    #[inline(always)]
    fn rows(&self, block: usize) -> &[Row] {
        let first = block * (BLOCK / ROW) * K::ROWS;
        &self.units[first..first + BLOCK / ROW * K::ROWS]
    }

    /// The numbers of the triangles; lanes without a pair repeat the first.
    #[inline(always)]
    fn ids_of(&self, lanes: &Lanes) -> [u32; ROW] {
        let mut ids = [self.ids.get(lanes.slot(0)); ROW];
        for (lane, id) in ids.iter_mut().enumerate().take(lanes.len) {
            *id = self.ids.get(lanes.slot(lane));
        }
        ids
    }
}

impl<K: Kernel> TriangleBlocks<'_, K> {
    /// Corners that the mesh holds, as the kernel sees them.
    #[inline(always)]
    pub(super) fn corners_in_place<S: Simd>(&self, s: S, ids: &[u32; ROW]) -> [Vec3Lanes<S>; 3] {
        let mesh: &MeshRef = &self.triangles.shape.mesh;
        let mut quads = [[[0.0; 4]; ROW]; 3];
        for (lane, id) in ids.iter().enumerate().take(S::LANES) {
            for (quads, corner) in quads.iter_mut().zip(mesh.corners(*id as usize)) {
                quads[lane] = [corner.x, corner.y, corner.z, 0.0];
            }
        }
        let scale = self.triangles.frame.scale;
        let mut corners = [[s.splat(0.0); 3]; 3];
        for (corner, quads) in corners.iter_mut().zip(&quads) {
            let mut places = [&quads[0]; ROW];
            for (place, quad) in places.iter_mut().zip(quads) {
                *place = quad;
            }
            let [x, y, z, _] = s.load_quads(&places);
            *corner = [x, y, z];
            if scale != 1.0 {
                for value in corner {
                    *value = s.mul(*value, s.splat(scale));
                }
            }
        }
        corners
    }

    /// Up to `LANES` candidates taken off a mask, by number, and how many they are.
    #[inline(always)]
    pub(super) fn next_in_place<S: Simd>(
        &self,
        set: &mut super::search::Candidates<K>,
    ) -> ([u32; ROW], usize) {
        let (mut chosen, mut len) = ([0; ROW], 0);
        while len < S::LANES
            && let Some(place) = next_bit(&mut set.mask)
        {
            let object = self.ids.get(set.block * BLOCK + place);
            if object != EMPTY_SLOT {
                chosen[len] = object;
                len += 1;
            }
        }
        let first = chosen[0];
        chosen[len..].fill(first);
        (chosen, len)
    }
}
