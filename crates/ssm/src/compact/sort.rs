//! An order of rays in which neighbours go similar ways, so that they find in the caches what the
//! one before brought there.

use super::segment::greater;
use accel::{Aabb, Ray};
use lanes::packet::rows;
use lanes::{Level, ROW, Simd, Task};

/// Bits of an origin's coordinate.
const PLACE: u32 = 4;
/// Bits of a direction's coordinate besides its sign.
const TURN: u32 = 2;

/// Whether neighbours in a list mostly go the same way, as towards a light from one pixel and the next: of one pair in `sample`
/// the squared cosine of the angle between them exceeds `alike`.
#[inline(always)]
pub(super) fn is_coherent(rays: &[Ray], sample: usize, alike: f32) -> bool {
    let pairs = rays.windows(2).step_by(sample);
    let count = pairs.len();
    let close = pairs.filter(|pair| {
        let [a, b] = [pair[0].direction, pair[1].direction];
        let along = a.dot(b);
        along > 0.0 && along * along > alike * a.length_squared() * b.length_squared()
    });
    4 * close.count() >= 3 * count
}

/// The numbers of the rays in an order by the place in the box that their origin is nearest to, then by
/// direction. Rays from the hits of an image stay with their neighbours.
pub(super) fn coherent(simd: Level, rays: &[Ray], bounds: &Aabb) -> Vec<u32> {
    let mut keyed = vec![(0, 0); rays.len()];
    simd.run(Keys { rays, bounds, keyed: &mut keyed });
    let mut other = vec![(0, 0); keyed.len()];
    sort_by_digit(&keyed, &mut other, 0);
    sort_by_digit(&other, &mut keyed, DIGIT);
    keyed.into_iter().map(|(_, number)| number).collect()
}

/// Gives each ray a key, and its number.
struct Keys<'a> {
    rays: &'a [Ray],
    bounds: &'a Aabb,
    keyed: &'a mut [(u32, u32)],
}

impl Task for Keys<'_> {
    type Out = ();

    /// In loops over lanes without branches, which compilers turn into vectors.
    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let Self { rays, bounds, keyed } = self;
        let scale = bounds.extent().recip() * (1 << PLACE) as f32;
        for (chunk, (rays, keyed)) in rays.chunks(ROW).zip(keyed.chunks_mut(ROW)).enumerate() {
            let rows = rows(s, rays);
            let mut keys = [0u32; ROW];
            let [dx, dy, dz] = &rows.direction;
            for lane in 0..ROW {
                let longest = greater(greater(dx[lane].abs(), dy[lane].abs()), dz[lane].abs());
                let turns = (1 << TURN) as f32 / longest;
                let (mut place, mut turn, mut octant) = (0, 0, 0);
                for a in 0..3 {
                    // Casts saturate: an origin outside counts as on the side it is nearest to.
                    let at = ((rows.origin[a][lane] - bounds.min[a]) * scale[a]) as u32;
                    place |= spread(at.min((1 << PLACE) - 1)) << a;
                    let along = rows.direction[a][lane] * turns;
                    turn |= spread((along.abs() as u32).min((1 << TURN) - 1)) << a;
                    octant |= u32::from(along < 0.0) << a;
                }
                keys[lane] = (place << 3 | octant) << (3 * TURN) | turn;
            }
            for (lane, keyed) in keyed.iter_mut().enumerate() {
                *keyed = (keys[lane], (chunk * ROW + lane) as u32);
            }
        }
    }
}

/// Bit i of the lowest four to bit 3i.
#[inline(always)]
const fn spread(i: u32) -> u32 {
    i & 1 | (i & 2) << 2 | (i & 4) << 4 | (i & 8) << 6
}

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
    fn rays_towards_a_light_are_coherent_and_scattered_ones_are_not() {
        let towards = |i: i32| {
            Ray::new(Vec3::new(i as f32 * 1e-3, 0.0, 0.0), Vec3::new(0.5 - i as f32 * 1e-3, 3.0, 1.0))
        };
        let rays: Vec<Ray> = (0..1000).map(towards).collect();
        assert!(is_coherent(&rays, 61, 0.85));
        let turned =
            |i: usize| Ray { direction: if i.is_multiple_of(2) { Vec3::X } else { Vec3::Y }, ..rays[i] };
        assert!(!is_coherent(&(0..1000).map(turned).collect::<Vec<_>>(), 61, 0.85));
        let nowhere = vec![Ray::new(Vec3::ZERO, Vec3::splat(f32::MAX)); 100];
        assert!(!is_coherent(&nowhere, 61, 0.85), "what can't be told is put in order");
    }

    #[test]
    fn the_angle_between_neighbours_decides() {
        // A tenth of a right angle, back and forth: a squared cosine of 0.976.
        let turned = |i: u32| {
            let angle = if i.is_multiple_of(2) { 0.0 } else { 0.1 * std::f32::consts::FRAC_PI_2 };
            Ray::new(Vec3::ZERO, Vec3::new(angle.cos(), angle.sin(), 0.0) * (i + 1) as f32)
        };
        let rays: Vec<Ray> = (0..100).map(turned).collect();
        assert!(is_coherent(&rays, 5, 0.97));
        assert!(!is_coherent(&rays, 5, 0.98));
    }

    #[test]
    fn every_ray_comes_once_and_like_comes_to_like() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let rays: Vec<Ray> = (0..100)
            .map(|i| {
                let side = if i % 2 == 0 { 1.0 } else { -1.0 };
                Ray::new(Vec3::new(0.51, f32::MAX, -1e-30), Vec3::new(side, 1e-40, 0.0))
            })
            .collect();
        let order = coherent(Level::Portable, &rays, &bounds);
        let signs: Vec<bool> = order.iter().map(|i| rays[*i as usize].direction.x < 0.0).collect();
        assert_eq!(signs.windows(2).filter(|pair| pair[0] != pair[1]).count(), 1);
        let mut order = order;
        order.sort_unstable();
        assert!(order.into_iter().eq(0..100));
    }
}
