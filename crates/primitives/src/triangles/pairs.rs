//! Rays and packed triangles brought together, one of each in a lane.

use super::{CORNER_ROWS, TriangleBlocks};
use crate::kernel::{Floats, Kernel};
use accel::{MeshRef, Nearest};
use lanes::packet::{Pairs, Vec3Lanes};
use lanes::{BLOCK, ROW, Simd};

/// `LANES` of the pairs, or those that are left.
pub(super) struct Group<'a, S: Simd> {
    /// The ray of each lane, by its place in the packet.
    pub ray: S::U,
    /// The same in memory.
    pub places: &'a [u8],
    /// The triangle of each lane, by its slot in the block.
    pub slots: &'a [u8],
    /// A bit for each lane that holds a pair.
    pub wanted: u32,
}

impl<'a, S: Simd> Group<'a, S> {
    /// The pairs from `at` on.
    #[inline(always)]
    pub fn at(s: S, pairs: &Pairs<'a, S>, at: usize) -> Self {
        let left = pairs.len - at;
        let wanted = if left < S::LANES { (1 << left) - 1 } else { u32::MAX >> (32 - S::LANES) };
        let (places, slots) = (&pairs.rays[at..], &pairs.slots[at..]);
        Self { ray: s.load_bytes(places), places, slots, wanted }
    }

    /// The place of the ray in a lane.
    #[inline(always)]
    pub fn place(&self, lane: usize) -> usize {
        usize::from(self.places[lane]) % ROW
    }
}

/// Up to what t each ray looks.
#[inline(always)]
pub(super) fn limits(best: &[Nearest; ROW]) -> [f32; ROW] {
    let mut limits = [0.0; ROW];
    for (limit, best) in limits.iter_mut().zip(best) {
        *limit = best.t;
    }
    limits
}

impl<K: Kernel<Storage = Floats>> TriangleBlocks<'_, K> {
    /// The slot of a lane's triangle.
    #[inline(always)]
    pub(super) fn slot_of<S: Simd>(&self, pairs: &Pairs<S>, group: &Group<S>, lane: usize) -> usize {
        pairs.block * BLOCK + usize::from(group.slots[lane])
    }

    /// The corners of each lane's triangle as the kernel sees them.
    #[inline(always)]
    pub(super) fn corners_each<S: Simd>(
        &self,
        s: S,
        pairs: &Pairs<S>,
        group: &Group<S>,
    ) -> [Vec3Lanes<S>; 3] {
        if self.in_place {
            return self.corners_in_place(s, &self.ids_of(pairs, group));
        }
        let slot = s.load_bytes(group.slots);
        let first = pairs.block * (BLOCK / ROW) * K::ROWS;
        let packed = &self.units[first..first + BLOCK / ROW * K::ROWS];
        let mut corners = [[s.splat(0.0); 3]; 3];
        for (corner, values) in corners.iter_mut().enumerate() {
            for (axis, value) in values.iter_mut().enumerate() {
                const { assert!(K::ROWS >= CORNER_ROWS, "the kernel packs corners") };
                let row = &packed[3 * corner + axis..];
                let [a, b, c, d] = [&row[0], &row[K::ROWS], &row[2 * K::ROWS], &row[3 * K::ROWS]];
                *value = s.lookup([a, b, c, d], slot);
            }
        }
        corners
    }

    /// The numbers of the triangles; lanes without a pair repeat the first.
    #[inline(always)]
    fn ids_of<S: Simd>(&self, pairs: &Pairs<S>, group: &Group<S>) -> [u32; ROW] {
        let mut ids = [self.ids.get(self.slot_of(pairs, group, 0)); ROW];
        for (lane, id) in ids.iter_mut().enumerate().take(group.wanted.count_ones() as usize) {
            *id = self.ids.get(self.slot_of(pairs, group, lane));
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
        while set.mask != 0 && len < S::LANES {
            let object = self.ids.get(set.block * BLOCK + set.mask.trailing_zeros() as usize);
            set.mask &= set.mask - 1;
            if object != lanes::EMPTY_SLOT {
                chosen[len] = object;
                len += 1;
            }
        }
        let first = chosen[0];
        chosen[len..].fill(first);
        (chosen, len)
    }
}
