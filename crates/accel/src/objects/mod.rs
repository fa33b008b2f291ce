//! What a structure asks of the objects of a scene.

mod boxes;
mod frame;
mod ids;
mod lattice;
mod one_by_one;
mod triangles;

pub use boxes::Boxes;
pub use one_by_one::OneByOne;
pub use triangles::{TriangleBlocks, Triangles};

use crate::packet::{Common, NearestPacket, Packet};
use crate::simd::{Row, Simd};
use crate::{Aabb, Nearest, Ray, Surface};

/// Objects in a block: one bit each of a 64-bit word.
pub const BLOCK: usize = 64;

/// In an order of objects: a slot that holds none.
pub const EMPTY_SLOT: u32 = u32::MAX;

/// The objects of a scene, of any kind: a structure needs their boxes and a detail test
/// (Skala 1993, §1, §7).
///
/// # The law
/// `intersect` reports a hit at t only if the ray's line meets `bounds(id)` and t lies in
/// the range of that meeting, give or take [`T_SLACK`]`·|t|`. The boxes are padded so that no hit worth having is
/// refused. A structure that never loses an object whose box a ray meets therefore
/// equals brute force bit for bit.
pub trait Objects: Copy + Send + Sync {
    /// The objects reordered and packed by 64.
    type Blocks: Blocks;

    /// How many there are, below `u32::MAX`.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The object's padded box: finite, and not empty.
    ///
    /// # Panics
    /// If there is no such object.
    fn bounds(&self, id: u32) -> Aabb;

    /// Where the ray meets the object at t in `[ray.t_min, t_max]`; `ray.t_max` is not looked at.
    ///
    /// # Panics
    /// If there is no such object.
    fn intersect(&self, id: u32, ray: &Ray, t_max: f32) -> Option<Surface>;

    /// Tests an object and takes its hit if that comes before `best`: at a lower t, or at the same reported t
    /// by number unless the objects can tell their order more exactly.
    ///
    /// # Panics
    /// If there is no such object.
    #[inline]
    fn closest(&self, id: u32, ray: &Ray, best: &mut Nearest) {
        if let Some(surface) = self.intersect(id, ray, best.t) {
            best.offer(id, surface);
        }
    }

    /// Copies the objects into blocks: slot i holds object `order[i]`, or nothing for [`EMPTY_SLOT`].
    fn blocks(&self, order: &[u32]) -> Self::Blocks;
}

/// Relative slack of t that the law of [`Objects`] allows for.
pub const T_SLACK: f64 = 1.0 / (1 << 20) as f64;

/// Objects packed in blocks of 64 slots, tested by mask.
pub trait Blocks: Send + Sync {
    /// One ray, prepared.
    type One: Copy;
    /// `LANES` rays, prepared.
    type Many<S: Simd>: Copy;

    /// Bytes on the heap: a copy of geometry.
    fn bytes(&self) -> usize;

    /// The object in a slot, or [`EMPTY_SLOT`].
    fn object(&self, slot: usize) -> u32;

    /// Prepares a ray.
    fn one(&self, ray: &Ray) -> Self::One;

    /// Prepares `LANES` rays.
    fn many<S: Simd>(&self, s: S, rays: &Packet<S>) -> Self::Many<S>;

    /// Tests the objects of `block` whose bits are set in `mask`. Hits may be postponed until [`Blocks::settle`].
    fn closest<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, best: &mut Nearest);

    /// Whether any object of `block` whose bit is set in `mask` is hit at t in
    /// `[ray.t_min, t_max]`.
    fn any<S: Simd>(&self, s: S, block: usize, mask: u64, ray: &Self::One, t_max: f32) -> bool {
        let mut best = Nearest::new(t_max);
        // A hit that is postponed is a certain one.
        self.closest(s, block, mask, ray, &mut best);
        best.object != Nearest::NONE
    }

    /// Decides what [`Blocks::closest`] postponed: before it, `best` holds an upper bound of t, after it a hit. By default
    /// nothing is postponed.
    #[inline(always)]
    fn settle(&self, ray: &Self::One, best: &mut Nearest) {
        let _ = (ray, best);
    }

    /// Tests the object of one slot with `LANES` rays. Hits may be postponed until [`Blocks::settle_packet`].
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Self::Many<S>, best: &mut NearestPacket<S>);

    /// Rows of values for each 16 slots that [`Blocks::prepare`] computes.
    const PREPARED_ROWS: usize = 0;

    /// Computes, for the 16 slots from `first` on (a multiple of 16), whatever is the same for all rays
    /// with this in common.
    ///
    /// # Panics
    /// If `rows` are fewer than [`Blocks::PREPARED_ROWS`].
    #[inline(always)]
    fn prepare<S: Simd>(&self, s: S, first: usize, common: &Common, rows: &mut [Row]) {
        let _ = (s, first, common, rows);
    }

    /// [`Blocks::packet`] for rays with this in common, with the rows prepared for the slot's 16:
    /// the same operations, so the same bits, but those that don't depend on the ray done before.
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
        let _ = (common, rows);
        self.packet(s, slot, rays, best);
    }

    /// [`Blocks::settle`] for what [`Blocks::packet`] postponed.
    #[inline(always)]
    fn settle_packet<S: Simd>(&self, s: S, rays: &Self::Many<S>, best: &mut NearestPacket<S>) {
        let _ = (s, rays, best);
    }
}

/// The padding of boxes: large against the rounding of a hit's position in `f32`, small
/// against anything seen in an image.
pub(crate) fn pad_of(bounds: &Aabb) -> f32 {
    if bounds.is_empty() { 0.0 } else { bounds.extent().max_element() / (1 << 17) as f32 }
}

/// Whether a hit at `t` keeps the law for `bounds`.
#[inline]
pub(crate) fn lawful(bounds: &Aabb, ray: &Ray, t: f32) -> bool {
    let Some((near, far)) = bounds.overlap(ray.origin, ray.direction) else {
        return false;
    };
    let t = f64::from(t);
    let slack = T_SLACK * t.abs();
    near - slack <= t && t <= far + slack
}

#[cfg(test)]
mod tests;
