//! Hits and misses in `f64`, with t rounded correctly.

use super::meeting::{Meeting, error_of, greatest3, least3};
use super::quotient::Quotient;
use super::signs::{Place, meets_corner, place};
use crate::kernel::wide::{Pairs, Products};
use accel::{Corners, Ray};
use lanes::packet::Lanes;
use lanes::{ROW, Simd, next_lane};

/// Up to so many lanes are decided one by one.
const FEW: u32 = 2;

/// Decisions in memory.
struct Decisions {
    /// 0: missed, 1: hit, 2: neither is certain, 3: a hit if inside, which is not certain.
    state: [f32; ROW],
    t: [f32; ROW],
    u: [f32; ROW],
    v: [f32; ROW],
}

/// Decides the lanes `undecided`; the others hold no hit.
#[inline(always)]
pub(super) fn decide<S: Simd>(s: S, pairs: &impl Pairs, undecided: u32) -> Lanes<S> {
    let mut rows = Decisions { state: [0.0; ROW], t: [0.0; ROW], u: [0.0; ROW], v: [0.0; ROW] };
    if undecided.count_ones() <= FEW {
        let mut left = undecided;
        while let Some(lane) = next_lane(&mut left) {
            rows.decide(pairs, lane);
        }
    } else {
        for lane in 0..S::LANES {
            rows.decide(pairs, lane);
        }
    }
    let known = s.load(&rows.state);
    let uncertain = s.bits(s.lt(s.splat(1.5), known)) & undecided;
    let mut hits = s.bits(s.eq(known, s.splat(1.0))) & undecided;
    if uncertain != 0 {
        hits |= rows.resolve(pairs, uncertain);
    }
    Lanes { hit: s.mask(hits), t: s.load(&rows.t), u: s.load(&rows.u), v: s.load(&rows.v) }
}

impl Decisions {
    /// Without branches, so that loops over lanes become vectors.
    #[inline(always)]
    fn decide(&mut self, pairs: &impl Pairs, lane: usize) {
        let ray = pairs.ray(lane);
        let products = Products::of(&ray, &pairs.corners(lane));
        let Products { det, scaled: [u, v, _], .. } = products;
        let error = error_of(&products);
        let w = det - u - v;
        let (least, greatest) = (least3(u, v, w), greatest3(u, v, w));
        let missed = (error < greatest) & (least < -error);
        let inside = (error < least) | (greatest < -error);

        let Meeting { low, high, u, v, firm, starts_on } = Meeting::of(&products, error);
        // At an end of the range, the rounded t doesn't tell on which side the true one lies.
        let clear = (low == high) & (starts_on | ((low != ray.t_min) & (low != ray.t_max)));
        // Rounding keeps order: t is out of the range if what it is rounded to at least or at most is.
        let missed = missed | (firm & ((high < ray.t_min) | (ray.t_max < low)));
        let uncertain = if firm & clear { 3.0 } else { 2.0 };
        self.state[lane] = if inside & firm & clear { 1.0 } else { uncertain };
        self.state[lane] = if missed { 0.0 } else { self.state[lane] };
        self.t[lane] = low;
        (self.u[lane], self.v[lane]) = (u, v);
    }

    /// Decides the lanes `uncertain` by exact signs and, where t is not known, by its exact quotient, and tells which
    /// are hit.
    #[cold]
    fn resolve(&mut self, pairs: &impl Pairs, mut uncertain: u32) -> u32 {
        let mut hits = 0;
        while let Some(lane) = next_lane(&mut uncertain) {
            let (ray, corners) = (pairs.ray(lane), pairs.corners(lane));
            if !usable(&ray, &corners) {
                continue;
            }
            let needs_only_inside = self.state[lane] == 3.0;
            if needs_only_inside && meets_corner(&ray, &corners) {
                hits |= 1 << lane;
                continue;
            }
            match place(&ray, &corners) {
                Place::Outside => {}
                Place::Inside(_) if needs_only_inside => hits |= 1 << lane,
                Place::Inside(_) => {
                    if let Some(found) = in_range(&ray, &corners) {
                        hits |= 1 << lane;
                        (self.t[lane], self.u[lane], self.v[lane]) = found.into();
                    }
                }
            }
        }
        hits
    }
}

/// Whether every number is one.
fn usable(ray: &Ray, corners: &Corners) -> bool {
    ray.origin.is_finite()
        && ray.direction.is_finite()
        && corners.iter().all(|corner| corner.is_finite())
        && !ray.t_min.is_nan()
        && !ray.t_max.is_nan()
}

/// t, u and v where the ray meets the triangle's plane, if that is in its range.
#[cold]
fn in_range(ray: &Ray, corners: &Corners) -> Option<[f32; 3]> {
    let at = Quotient::of(ray, corners)?;
    let within = at.compare(ray.t_min).is_ge() && at.compare(ray.t_max).is_le();
    within.then(|| at.rounded())
}
