//! Blocks of objects that know no packed form.

use super::{Blocks, EMPTY_SLOT, Objects};
use crate::packet::{NearestPacket, Packet, lane_of};
use crate::simd::{ROW, Simd};
use crate::{Nearest, Ray};

/// Tests the objects of a block by [`Objects::intersect`], bit by bit.
#[derive(Clone, Debug)]
pub struct OneByOne<O> {
    objects: O,
    order: Vec<u32>,
}

impl<O: Objects> OneByOne<O> {
    /// Slot i holds object `order[i]`.
    pub fn new(objects: O, order: &[u32]) -> Self {
        Self { objects, order: order.to_vec() }
    }
}

impl<O: Objects> Blocks for OneByOne<O> {
    type One = Ray;
    type Many<S: Simd> = Packet<S>;

    fn bytes(&self) -> usize {
        crate::vec_bytes(&self.order)
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
        while mask != 0 {
            let slot = block * super::BLOCK + mask.trailing_zeros() as usize;
            mask &= mask - 1;
            let object = self.order[slot];
            if object != EMPTY_SLOT
                && let Some(surface) = self.objects.intersect(object, ray, best.t)
            {
                best.offer(object, surface);
            }
        }
    }

    #[inline(always)]
    fn packet<S: Simd>(&self, s: S, slot: usize, rays: &Packet<S>, best: &mut NearestPacket<S>) {
        let object = self.order[slot];
        if object == EMPTY_SLOT {
            return;
        }
        let (mut t, mut u, mut v) = ([0.0; ROW], [0.0; ROW], [0.0; ROW]);
        let mut hit = 0;
        for lane in 0..S::LANES {
            let t_max = lane_of(s, best.t, lane);
            if t_max == f32::NEG_INFINITY {
                continue;
            }
            if let Some(surface) = self.objects.intersect(object, &rays.ray(s, lane), t_max) {
                hit |= 1 << lane;
                (t[lane], u[lane], v[lane]) = (surface.t, surface.u, surface.v);
            }
        }
        let lanes = crate::packet::Lanes { hit: s.mask(hit), t: s.load(&t), u: s.load(&u), v: s.load(&v) };
        best.offer(s, object, &lanes);
    }
}
