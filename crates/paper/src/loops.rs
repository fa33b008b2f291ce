//! The loops that Tables 2–5 compare, without detail tests: a bounding volume tested for every object,
//! and the words of two or three bit maps combined (Skala 1993, §2–4 and appendix).

use accel::{Aabb, Vec3};
use lanes::{Simd, Task};
use std::hint::black_box;

/// Stands where the detail test would be: counts, and keeps the compiler from merging calls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Detail {
    /// Candidates so far.
    pub count: u64,
}

impl Detail {
    #[inline(always)]
    fn test(&mut self, object: usize) {
        self.count += 1;
        black_box(object);
    }
}

/// A min-max box of the image.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    /// Least x and y.
    pub min: [f32; 2],
    /// Greatest x and y.
    pub max: [f32; 2],
}

/// A bounding circle of the image.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    /// Centre.
    pub center: [f32; 2],
    /// Square of the radius.
    pub square: f32,
}

/// A bounding sphere as one eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// s₁: from the eye to the centre.
    pub to_center: Vec3,
    /// q = s₁ᵀs₁ − r².
    pub rest: f32,
}

/// x_min ≤ x ≤ x_max and y_min ≤ y ≤ y_max (§2).
#[inline(never)]
pub fn minmax_parallel(rects: &[Rect], [x, y]: [f32; 2], detail: &mut Detail) {
    for (object, rect) in rects.iter().enumerate() {
        if rect.min[0] <= x && x <= rect.max[0] && rect.min[1] <= y && y <= rect.max[1] {
            detail.test(object);
        }
    }
}

/// (x − x_s)² + (y − y_s)² < r² (§2).
#[inline(never)]
pub fn sphere_parallel(circles: &[Circle], [x, y]: [f32; 2], detail: &mut Detail) {
    for (object, circle) in circles.iter().enumerate() {
        let (dx, dy) = (x - circle.center[0], y - circle.center[1]);
        if dx * dx + dy * dy < circle.square {
            detail.test(object);
        }
    }
}

/// The nearest meeting of a ray and a box by three pairs of planes, with a division for each (§4).
#[inline(never)]
pub fn minmax_perspective(boxes: &[Aabb], origin: Vec3, direction: Vec3, detail: &mut Detail) {
    for (object, bounds) in boxes.iter().enumerate() {
        let (a, b) = ((bounds.min - origin) / direction, (bounds.max - origin) / direction);
        if a.min(b).max_element() <= a.max(b).min_element() {
            detail.test(object);
        }
    }
}

/// w = s₁ᵀs₂, w² − q ≥ 0, the direction s₂ being of unit length (§4).
#[inline(never)]
pub fn sphere_perspective(spheres: &[Sphere], unit: Vec3, detail: &mut Detail) {
    for (object, sphere) in spheres.iter().enumerate() {
        let w = sphere.to_center.dot(unit);
        if w * w - sphere.rest >= 0.0 {
            detail.test(object);
        }
    }
}

/// The loop of the appendix: 32-bit words, shifted out bit by bit.
#[inline(always)]
pub fn appendix(words: impl Iterator<Item = u32>, detail: &mut Detail) {
    for (index, word) in words.enumerate() {
        let mut mask = word;
        let mut object = index << 5;
        while mask != 0 {
            if mask & 1 != 0 {
                detail.test(object);
            }
            mask >>= 1;
            object += 1;
        }
    }
}

/// 64-bit words and find-first-set.
#[inline(always)]
pub fn words(words: impl Iterator<Item = u64>, detail: &mut Detail) {
    for (index, word) in words.enumerate() {
        take(index, word, detail);
    }
}

#[inline(always)]
fn take(index: usize, mut mask: u64, detail: &mut Detail) {
    while mask != 0 {
        detail.test(index << 6 | mask.trailing_zeros() as usize);
        mask &= mask - 1;
    }
}

/// Words of a register at a time, passed over together where all are zero.
const WIDE: usize = 8;

/// Eight 64-bit words at once; meant to be compiled for wide registers, see [`Wide`].
#[inline(always)]
pub fn wide<const MAPS: usize>(maps: [&[u64]; MAPS], detail: &mut Detail) {
    let whole = maps[0].len() / WIDE * WIDE;
    let all = |at: usize| maps.iter().fold(u64::MAX, |all, map| all & map[at]);
    for first in (0..whole).step_by(WIDE) {
        let chunks = maps.map(|map| &map[first..first + WIDE]);
        let group: [u64; WIDE] =
            std::array::from_fn(|lane| chunks.iter().fold(u64::MAX, |all, chunk| all & chunk[lane]));
        if group.iter().fold(0, |any, word| any | word) != 0 {
            for (lane, word) in group.into_iter().enumerate() {
                take(first + lane, word, detail);
            }
        }
    }
    for at in whole..maps[0].len() {
        take(at, all(at), detail);
    }
}

/// A pass compiled for the instruction set it runs at.
pub struct Wide<F>(pub F);

impl<F: FnOnce() -> T, T> Task for Wide<F> {
    type Out = T;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> T {
        (self.0)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lanes::Level;

    #[test]
    fn all_loops_meet_the_same_bits() {
        let a: Vec<u64> = (0..37u64).map(|i| i.wrapping_mul(0x9E37_79B9_7F4A_7C15)).collect();
        let b: Vec<u64> = a.iter().rev().map(|w| w.rotate_left(7)).collect();
        let expected: u32 = a.iter().zip(&b).map(|(a, b)| (a & b).count_ones()).sum();
        let both = || a.iter().zip(&b).map(|(a, b)| a & b);
        let halves = both().flat_map(|w| [w as u32, (w >> 32) as u32]);
        let mut details = [Detail::default(); 3];
        appendix(halves, &mut details[0]);
        words(both(), &mut details[1]);
        for level in Level::here() {
            let mut detail = Detail::default();
            level.run(Wide(
                #[inline(always)]
                || wide([&a, &b], &mut detail),
            ));
            details[2] = detail;
            assert_eq!(details.map(|d| d.count), [u64::from(expected); 3]);
        }
    }
}
