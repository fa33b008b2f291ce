//! Blocks of objects that know no packed form.

use crate::bits::{next_bit, next_lane};
use crate::blocks::{BLOCK, Blocks, EMPTY_SLOT, PackedObjects};
use crate::packet::{Lanes, NearestPacket, Packet};
use crate::row::ROW;
use crate::simd::Simd;
use accel::{BuildError, Nearest, Objects, Ray};

/// Objects that know no packed form: those of a block are tested one by one, where the scene has them.
pub trait Unpacked: Objects + Copy {}

impl<O: Unpacked> PackedObjects for O {
    type Blocks = OneByOne<Self>;
    type Shape = Self;

    fn shape(&self) -> Self {
        *self
    }

    fn blocks(&self, structure: &str, order: &[u32]) -> Result<Self::Blocks, BuildError> {
        OneByOne::new(*self, structure, order)
    }
}

/// Tests the objects of a block by [`Objects::intersect`], bit by bit.
#[derive(Clone, Debug)]
pub struct OneByOne<O> {
    objects: O,
    order: Vec<u32>,
}

impl<O: Objects> OneByOne<O> {
    /// Slot i holds object `order[i]`.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory.
    pub fn new(objects: O, structure: &str, order: &[u32]) -> Result<Self, BuildError> {
        let mut slots = accel::reserved(structure, order.len())?;
        slots.extend_from_slice(order);
        Ok(Self { objects, order: slots })
    }
}

impl<O: Objects> Blocks for OneByOne<O> {
    type One = Ray;
    type Many<S: Simd> = Packet<S>;

    fn bytes(&self) -> usize {
        accel::vec_bytes(&self.order)
    }

    #[inline]
    fn object(&self, slot: usize) -> u32 {
        self.order[slot]
    }

    #[inline(always)]
    fn one(&self, ray: &Ray) -> Ray {
        *ray
    }

    #[inline(always)]
    fn many<S: Simd>(&self, _: S, rays: &Packet<S>) -> Packet<S> {
        *rays
    }

    #[inline(always)]
    fn closest<S: Simd>(&self, _: S, block: usize, mut mask: u64, ray: &Ray, best: &mut Nearest) {
        while let Some(place) = next_bit(&mut mask) {
            let object = self.order[block * BLOCK + place];
            if object != EMPTY_SLOT {
                self.objects.closest(object, ray, best);
            }
        }
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Packet<S>, best: &mut NearestPacket<S>) {
        let object = self.order[slot];
        if object != EMPTY_SLOT {
            one_by_one(s, (&self.objects, object), u32::MAX >> (32 - S::LANES), rays, best);
        }
    }
}

/// Tests an object by [`Objects::closest`] against the rays of some lanes.
#[inline(always)]
pub fn one_by_one<O: Objects, S: Simd>(
    s: S,
    (objects, object): (&O, u32),
    mut lanes: u32,
    rays: &Packet<S>,
    best: &mut NearestPacket<S>,
) {
    let mut before = [Nearest::new(0.0); ROW];
    best.store(s, &mut before);
    let (mut t, mut u, mut v) = ([0.0; ROW], [0.0; ROW], [0.0; ROW]);
    let mut wins = 0;
    while let Some(lane) = next_lane(&mut lanes) {
        let mut nearest = before[lane];
        if nearest.t == f32::NEG_INFINITY {
            continue;
        }
        objects.closest(object, &rays.ray(s, lane), &mut nearest);
        wins |= u32::from(nearest.object != before[lane].object) << lane;
        (t[lane], u[lane], v[lane]) = (nearest.t, nearest.u, nearest.v);
    }
    let wins = s.mask(wins);
    best.take(s, wins, object, &Lanes { hit: wins, t: s.load(&t), u: s.load(&u), v: s.load(&v) });
}
