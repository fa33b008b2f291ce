//! An order of rays in which neighbours go similar ways, so that they find in the caches what the
//! one before brought there.

use accel::{Aabb, Ray};

/// Bits of an origin's coordinate.
const PLACE: u32 = 4;
/// Bits of a direction's coordinate besides its sign.
const TURN: u32 = 2;

/// The numbers of the rays in an order by the place in the box that their origin is nearest to, then by
/// direction. Rays from the hits of an image stay with their neighbours.
pub(super) fn coherent(rays: &[Ray], bounds: &Aabb) -> Vec<u32> {
    let scale = bounds.extent().recip() * (1 << PLACE) as f32;
    let key = |ray: &Ray| {
        let along = ray.direction * (ray.direction.abs().max_element().recip() * (1 << TURN) as f32);
        let (mut place, mut turn, mut octant) = (0, 0, 0);
        for a in 0..3 {
            // Casts saturate: an origin outside counts as on the side it is nearest to.
            let at = ((ray.origin[a] - bounds.min[a]) * scale[a]) as u32;
            place |= SPREAD[at.min((1 << PLACE) - 1) as usize] << a;
            turn |= SPREAD[(along[a].abs() as u32).min((1 << TURN) - 1) as usize] << a;
            octant |= u32::from(along[a] < 0.0) << a;
        }
        (place << 3 | octant) << (3 * TURN) | turn
    };
    let mut keyed: Vec<(u32, u32)> = rays.iter().map(key).zip(0..).collect();
    let mut other = vec![(0, 0); keyed.len()];
    sort_by_digit(&keyed, &mut other, 0);
    sort_by_digit(&other, &mut keyed, DIGIT);
    keyed.into_iter().map(|(_, number)| number).collect()
}

/// Bit i to bit 3i.
const SPREAD: [u32; 1 << PLACE] = {
    let mut spread = [0; 1 << PLACE];
    let mut i = 0;
    while i < 1 << PLACE {
        spread[i] = (i & 1 | (i & 2) << 2 | (i & 4) << 4 | (i & 8) << 6) as u32;
        i += 1;
    }
    spread
};

/// Bits of a key that one pass of sorting looks at; two passes see all.
const DIGIT: u32 = 11;
const _: () = assert!(2 * DIGIT >= 3 * PLACE + 3 + 3 * TURN);

/// Copies by the digit that begins at bit `shift`, equal digits in the order they come in.
fn sort_by_digit(from: &[(u32, u32)], to: &mut [(u32, u32)], shift: u32) {
    let digit = |key: u32| (key >> shift & ((1 << DIGIT) - 1)) as usize;
    let mut places = [0u32; 1 << DIGIT];
    for (key, _) in from {
        places[digit(*key)] += 1;
    }
    let mut before = 0;
    for place in &mut places {
        before += std::mem::replace(place, before);
    }
    for item in from {
        let place = &mut places[digit(item.0)];
        to[*place as usize] = *item;
        *place += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Vec3;

    #[test]
    fn every_ray_comes_once_and_like_comes_to_like() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let rays: Vec<Ray> = (0..100)
            .map(|i| {
                let side = if i % 2 == 0 { 1.0 } else { -1.0 };
                Ray::new(Vec3::new(0.51, f32::MAX, -1e-30), Vec3::new(side, 1e-40, 0.0))
            })
            .collect();
        let order = coherent(&rays, &bounds);
        let signs: Vec<bool> = order.iter().map(|i| rays[*i as usize].direction.x < 0.0).collect();
        assert_eq!(signs.windows(2).filter(|pair| pair[0] != pair[1]).count(), 1);
        let mut order = order;
        order.sort_unstable();
        assert!(order.into_iter().eq(0..100));
    }
}
