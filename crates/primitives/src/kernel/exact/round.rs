//! t, correctly rounded, of hits that are certain.

use super::meeting::{Meeting, error_of};
use super::quotient::Quotient;
use crate::kernel::wide::{Pairs, Products};
use lanes::packet::Lanes;
use lanes::{ROW, Simd, next_lane};

/// Hits in memory.
struct Hits {
    t: [f32; ROW],
    /// The same as t where t is known.
    high: [f32; ROW],
    u: [f32; ROW],
    v: [f32; ROW],
}

/// The hits of the lanes `certain`, which [`super::reject`] has found to be such: the line meets the inside, and t lies in the
/// ray's range and at neither end. [`super::decide`] would say the same, bit for bit.
#[inline(always)]
pub(super) fn round<S: Simd>(s: S, pairs: &impl Pairs, certain: u32) -> Lanes<S> {
    let mut rows = Hits { t: [0.0; ROW], high: [0.0; ROW], u: [0.0; ROW], v: [0.0; ROW] };
    for lane in 0..S::LANES {
        rows.estimate(pairs, lane);
    }
    let known = s.eq(s.load(&rows.t), s.load(&rows.high));
    let unknown = certain & !s.bits(known);
    if unknown != 0 {
        rows.resolve(pairs, unknown);
    }
    Lanes { hit: s.mask(certain), t: s.load(&rows.t), u: s.load(&rows.u), v: s.load(&rows.v) }
}

impl Hits {
    /// Without branches, so that loops over lanes become vectors.
    #[inline(always)]
    fn estimate(&mut self, pairs: &impl Pairs, lane: usize) {
        let products = Products::of(&pairs.ray(lane), &pairs.corners(lane));
        let Meeting { low, high, u, v, firm, .. } = Meeting::of(&products, error_of(&products));
        self.t[lane] = low;
        self.high[lane] = if firm { high } else { f32::NAN };
        (self.u[lane], self.v[lane]) = (u, v);
    }

    #[cold]
    fn resolve(&mut self, pairs: &impl Pairs, mut unknown: u32) {
        while let Some(lane) = next_lane(&mut unknown) {
            let at = Quotient::of(&pairs.ray(lane), &pairs.corners(lane));
            (self.t[lane], self.u[lane], self.v[lane]) = at.expect("a certain hit").rounded().into();
        }
    }
}
