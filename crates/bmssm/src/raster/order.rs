//! The order of objects: by size class, then by Morton code of column, row and depth.

use super::{Settings, THICKNESS};
use crate::image_space::{ImageSpace, Pixels};
use accel::{Objects, Projection, Raster};
use rayon::prelude::*;

/// Where the image shows an object.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    /// The object.
    pub id: u32,
    /// First and last slice of rows.
    pub rows: [u32; 2],
    /// First and last slice of columns.
    pub cols: [u32; 2],
    /// Lower bound of t.
    pub depth: f32,
}

/// Objects handled by one task.
const CHUNK: usize = 1 << 14;

/// The objects that both a row plane and a column plane touch.
pub(super) fn shown<O: Objects>(objects: O, raster: &Raster) -> Vec<Shown> {
    let space = ImageSpace::new(raster);
    let of = |first: usize| -> Vec<Shown> {
        (first..objects.len().min(first + CHUNK))
            .filter_map(|id| {
                let pixels = space.pixels(&objects.bounds(id as u32));
                let slices =
                    |r: &std::ops::Range<u32>| [r.start / super::THICKNESS, (r.end - 1) / super::THICKNESS];
                let Pixels { rows, cols, near } = &pixels;
                (!pixels.is_empty()).then(|| Shown {
                    id: id as u32,
                    rows: slices(rows),
                    cols: slices(cols),
                    depth: *near,
                })
            })
            .collect()
    };
    if objects.len() <= CHUNK {
        return of(0);
    }
    let parts: Vec<Vec<Shown>> =
        (0..objects.len().div_ceil(CHUNK)).into_par_iter().map(|i| of(i * CHUNK)).collect();
    parts.concat()
}

/// Bits of a coordinate in a Morton code.
const BITS: u32 = 10;

/// Every third bit from a number of [`BITS`] bits.
fn spread(v: u32) -> u32 {
    let v = (v | v << 16) & 0x0300_00ff;
    let v = (v | v << 8) & 0x0300_f00f;
    let v = (v | v << 4) & 0x030c_30c3;
    (v | v << 2) & 0x0924_9249
}

/// The places of `shown` in the order of blocks.
pub(super) fn sorted(shown: &[Shown], raster: &Raster, settings: &Settings) -> Vec<u32> {
    let side = raster.rows.max(raster.cols).div_ceil(THICKNESS).max(1);
    // Code units: the image's longer side has 2^BITS of them, so a slice has `slice`.
    let slice = (1 << BITS) as f32 / side as f32;
    // Counted from the far end: what has no room in a code is next to the eye, and little.
    let far = shown.iter().map(|s| s.depth).fold(0.0, f32::max);
    // A block is as deep as it is wide where a unit of depth is as long as a unit of the image: everywhere for
    // parallel projection, and by the logarithm for perspective.
    let pixel = raster.right.length().max(f32::MIN_POSITIVE) / raster.forward.length();
    let unit = slice / THICKNESS as f32 / pixel / (1 << settings.depth_bits) as f32;
    let deep = |depth: f32| match raster.projection {
        Projection::Parallel => (far - depth) * unit,
        Projection::Perspective => (far / depth).ln() * unit,
    };
    let apart = settings.apart;
    let last = ((1 << BITS) - 1) as f32;
    let code = |s: &Shown| {
        let middle = |[a, b]: [u32; 2]| (((a + b) as f32 * 0.5 * slice) as u32).min((1 << BITS) - 1);
        let size = (s.rows[1] - s.rows[0]).max(s.cols[1] - s.cols[0]) + 1;
        let class = u32::from(size > apart) + u32::from(size > 4 * apart) + u32::from(size > 16 * apart);
        let z = (last - deep(s.depth)).clamp(0.0, last) as u32;
        class << (3 * BITS) | spread(middle(s.cols)) << 2 | spread(middle(s.rows)) << 1 | spread(z)
    };
    let keyed: Vec<u64> = (0..shown.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|i| u64::from(code(&shown[i])) << 32 | i as u64)
        .collect();
    radix_sort(keyed).into_iter().map(|k| k as u32).collect()
}

/// Sorts by the upper 32 bits, stably.
fn radix_sort(mut keys: Vec<u64>) -> Vec<u64> {
    const DIGIT: u32 = 11;
    if keys.len() < 1 << DIGIT {
        keys.sort_unstable();
        return keys;
    }
    let mut other = vec![0; keys.len()];
    for shift in [32, 32 + DIGIT, 32 + 2 * DIGIT] {
        let digit = |key: u64| (key >> shift) as usize & ((1 << DIGIT) - 1);
        let mut next = [0usize; 1 << DIGIT];
        for &key in &keys {
            next[digit(key)] += 1;
        }
        let mut sum = 0;
        for n in &mut next {
            (*n, sum) = (sum, sum + *n);
        }
        for &key in &keys {
            let at = &mut next[digit(key)];
            other[*at] = key;
            *at += 1;
        }
        std::mem::swap(&mut keys, &mut other);
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radix_sort_sorts() {
        let mut seed = 1u64;
        let keys: Vec<u64> = (0..10_000)
            .map(|i| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                seed >> 32 << 32 | i
            })
            .collect();
        let mut expected = keys.clone();
        expected.sort_unstable();
        assert_eq!(radix_sort(keys), expected);
    }

    #[test]
    fn spreading_leaves_two_bits_between() {
        for v in [0, 1, 5, 0x155, 0x3ff] {
            let expected = (0..BITS).fold(0, |sum, bit| sum | (v >> bit & 1) << (3 * bit));
            assert_eq!(spread(v), expected);
        }
    }
}
