//! Some of the rays of a set.

use accel::{Raster, RaySet};

/// At most about `most` rays of a set, spread evenly: a coarser raster of the same image, or
/// every k-th ray of a list.
pub fn subsample(rays: &RaySet, most: usize) -> RaySet {
    let most = most.max(1);
    if rays.len() <= most {
        return rays.clone();
    }
    match rays {
        RaySet::Raster(raster) => {
            let shrink = (most as f64 / raster.len() as f64).sqrt();
            let fewer = |n: u32| ((f64::from(n) * shrink).floor() as u32).max(1);
            let (rows, cols) = (fewer(raster.rows), fewer(raster.cols));
            RaySet::Raster(Raster {
                rows,
                cols,
                right: raster.right * (raster.cols as f32 / cols as f32),
                down: raster.down * (raster.rows as f32 / rows as f32),
                ..*raster
            })
        }
        RaySet::List(list) => RaySet::List(
            (0..most).map(|i| list[(i as u128 * list.len() as u128 / most as u128) as usize]).collect(),
        ),
    }
}

/// At most `most` numbers below `len`, spread evenly but not regularly: one of each of `most`
/// equal ranges, chosen by a fixed hash, so that a raster's columns are all met.
pub fn sample(len: usize, most: usize) -> Vec<usize> {
    if len <= most {
        return (0..len).collect();
    }
    let start = |i: usize| (i as u128 * len as u128 / most as u128) as usize;
    let hash = |i: usize| ((i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 20) as usize;
    (0..most).map(|i| start(i) + hash(i) % (start(i + 1) - start(i))).collect()
}

/// The rays of those numbers as a list.
pub fn pick(rays: &RaySet, numbers: &[usize]) -> RaySet {
    RaySet::List(numbers.iter().map(|i| rays.ray(*i)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use accel::Vec3;

    #[test]
    fn thin_rasters_show_the_same_image() {
        let raster = testing::raster(200, 100);
        let RaySet::Raster(subsample) = subsample(&RaySet::Raster(raster), 200) else { panic!() };
        assert_eq!((subsample.rows, subsample.cols), (20, 10));
        let ends = |r: &Raster| (r.down * r.rows as f32, r.right * r.cols as f32);
        let off = |a: Vec3, b: Vec3| (a - b).length();
        let ((down, right), (whole_down, whole_right)) = (ends(&subsample), ends(&raster));
        assert!(off(down, whole_down) < 1e-5 && off(right, whole_right) < 1e-5);
        assert_eq!(super::subsample(&RaySet::Raster(raster), 20_000), RaySet::Raster(raster));
    }

    #[test]
    fn thin_lists_and_samples_are_spread() {
        let list = pick(&RaySet::Raster(testing::raster(10, 10)), &(0..100).collect::<Vec<_>>());
        let RaySet::List(subsample) = subsample(&list, 7) else { panic!() };
        assert_eq!(subsample.len(), 7);
        assert_eq!(subsample[3], list.ray(42));
        let numbers = sample(1000, 64);
        assert_eq!(numbers.len(), 64);
        assert!(numbers.windows(2).all(|w| w[0] < w[1]) && numbers[63] < 1000);
        let columns: std::collections::HashSet<_> = sample(1 << 16, 1 << 10).iter().map(|i| i % 64).collect();
        assert!(columns.len() > 60, "a sample of a raster meets all its columns");
        assert_eq!(sample(3, 64), [0, 1, 2]);
    }
}
