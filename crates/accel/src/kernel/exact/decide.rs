//! Hits and misses in `f64`, with t rounded correctly.
//!
//! The bounds are those of [`super::reject`] with ε = 2^-53; products of three `f32` neither under- nor overflow.

use super::{by_integers, corners_of};
use crate::kernel::wide::{Inputs, Products};
use crate::packet::{Lanes, Packet, Vec3Lanes};
use crate::simd::{ROW, Simd};

const BOUND: f64 = 64.0 * f64::EPSILON / 2.0;

/// Up to so many lanes are decided one by one.
const FEW: u32 = 2;

/// What is known of a lane.
#[derive(Clone, Copy)]
struct Decision {
    /// 0: missed, 1: hit, 2: neither is certain.
    state: f32,
    t: f32,
    u: f32,
    v: f32,
}

/// Decides the lanes `open`; the others hold no hit.
#[inline(always)]
pub(super) fn decide<S: Simd>(s: S, ray: &Packet<S>, corners: &[Vec3Lanes<S>; 3], open: u32) -> Lanes<S> {
    let inputs = Inputs::of(s, ray, corners);
    let mut t_range = [[0.0; ROW]; 2];
    s.store(ray.t_min, &mut t_range[0]);
    s.store(ray.t_max, &mut t_range[1]);
    let mut state = [0.0; ROW];
    let mut rows = [[0.0; ROW]; 3];
    let mut one = |lane: usize| {
        let decision = of_lane(&inputs.products(lane), t_range[0][lane], t_range[1][lane]);
        state[lane] = decision.state;
        (rows[0][lane], rows[1][lane], rows[2][lane]) = (decision.t, decision.u, decision.v);
    };
    if open.count_ones() <= FEW {
        let mut left = open;
        while left != 0 {
            one(left.trailing_zeros() as usize);
            left &= left - 1;
        }
    } else {
        for lane in 0..S::LANES {
            one(lane);
        }
    }
    let known = s.load(&state);
    let mut unsure = s.bits(s.lt(s.splat(1.5), known)) & open;
    let mut hits = s.bits(s.eq(known, s.splat(1.0))) & open;
    while unsure != 0 {
        let lane = unsure.trailing_zeros() as usize;
        unsure &= unsure - 1;
        if let Some(found) = by_integers(&ray.ray(s, lane), &corners_of(inputs.corners(lane))) {
            hits |= 1 << lane;
            (rows[0][lane], rows[1][lane], rows[2][lane]) = found.into();
        }
    }
    let [t, u, v] = rows.map(|row| s.load(&row));
    Lanes { hit: s.mask(hits), t, u, v }
}

/// Without branches, so that loops over lanes become vectors.
#[inline(always)]
fn of_lane(products: &Products, t_min: f32, t_max: f32) -> Decision {
    let Products { edges, from_a, direction, det, scaled: [u, v, t] } = *products;
    let largest = |v: [f64; 3]| v[0].abs().max(v[1].abs()).max(v[2].abs());
    let length = largest(edges[0]).max(largest(edges[1]));
    let size = from_a[0].abs() + from_a[1].abs() + from_a[2].abs() + length;
    let area = length * size * BOUND;
    let error = area * largest(direction);
    let t_error = area * length;
    let w = det - u - v;
    let (least, greatest) = (u.min(v).min(w), u.max(v).max(w));
    let missed = (error < greatest) & (least < -error);
    let inside = (error < least) | (greatest < -error);

    let quotient = t / det;
    // First-order errors of numerator and denominator; the factor covers the rest, the last term the roundings here.
    let off = (t_error + quotient.abs() * error) / (det.abs() - error) * 1.001
        + quotient.abs() * (4.0 * f64::EPSILON);
    // Adding zero makes −0 a +0.
    let (low, high) = ((quotient - off) as f32 + 0.0, (quotient + off) as f32 + 0.0);
    let one_float = (low == high) & (error < det.abs());
    // At an end of the range, the rounded t doesn't tell on which side the true one lies.
    let clear = (low != t_min) & (low != t_max);
    let hit = inside & one_float & clear;
    Decision {
        state: if hit {
            1.0
        } else if missed {
            0.0
        } else {
            2.0
        },
        t: low,
        u: (u / det) as f32,
        v: (v / det) as f32,
    }
}
