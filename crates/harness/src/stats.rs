//! Statistics of samples.

use scenes::Random;

/// What is quoted of a set of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// The middle sample, or the mean of the two in the middle.
    pub median: f64,
    /// Median of the absolute deviations from the median, in the samples' unit (not scaled to
    /// a standard deviation).
    pub mad: f64,
    /// The least sample.
    pub min: f64,
}

/// Summary of the samples, or `None` if there is none or one is not a number.
pub fn summary(samples: &[f64]) -> Option<Summary> {
    let median = median(samples)?;
    let deviations: Vec<f64> = samples.iter().map(|x| (x - median).abs()).collect();
    Some(Summary { median, mad: self::median(&deviations)?, min: least(samples) })
}

/// The least sample; +∞ if there is none. What is not a number counts as no sample.
pub fn least(samples: &[f64]) -> f64 {
    samples.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The middle sample, or the mean of the two in the middle; `None` if there is none or one is
/// not a number.
pub fn median(samples: &[f64]) -> Option<f64> {
    quantile(samples, 0.5)
}

/// The `q`-quantile, linear between the samples to both sides (Hyndman & Fan 1996, type 7);
/// `None` if there is no sample, one is not a number, or `q` is not in [0, 1].
pub fn quantile(samples: &[f64], q: f64) -> Option<f64> {
    if samples.is_empty() || samples.iter().any(|x| x.is_nan()) || !(0.0..=1.0).contains(&q) {
        return None;
    }
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = q * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    let share = at.fract();
    Some(if share == 0.0 { low } else { low + (high - low) * share })
}

/// Geometric mean of positive numbers; `None` if there is none or one is not positive and finite.
pub fn geometric_mean(values: &[f64]) -> Option<f64> {
    if values.is_empty() || values.iter().any(|v| !(*v > 0.0 && v.is_finite())) {
        return None;
    }
    Some((values.iter().map(|v| v.ln()).sum::<f64>() / values.len() as f64).exp())
}

/// A statistic of samples that come in groups, over cluster bootstrap draws (Davison & Hinkley 1997, §3.8): groups are
/// drawn with replacement and then samples from each, `draws` times. Which groups are drawn depends on `seed` and on how many
/// there are, so that what was sampled in the same groups can be drawn together. A group without a sample is left out.
///
/// Empty if there is no sample.
pub fn cluster_bootstrap(
    groups: &[Vec<f64>],
    draws: usize,
    seed: u64,
    statistic: impl Fn(&[Vec<f64>]) -> f64,
) -> Vec<f64> {
    let groups: Vec<&Vec<f64>> = groups.iter().filter(|group| !group.is_empty()).collect();
    if groups.is_empty() {
        return Vec::new();
    }
    let (mut random, mut within) = (Random::new(seed), Random::new(!seed));
    let mut drawn = vec![Vec::new(); groups.len()];
    let mut draw = || {
        for drawn in &mut drawn {
            let group = groups[random.below(groups.len())];
            drawn.clear();
            drawn.extend((0..group.len()).map(|_| group[within.below(group.len())]));
        }
        statistic(&drawn)
    };
    (0..draws).map(|_| draw()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[3.0]), Some(3.0));
        assert_eq!(median(&[9.0, 1.0, 3.0]), Some(3.0));
        assert_eq!(median(&[9.0, 1.0, 3.0, 5.0]), Some(4.0));
        assert_eq!(median(&[1.0, f64::NAN]), None);
    }

    #[test]
    fn deviation_is_from_the_median_and_absolute() {
        // The textbook sample: median 2, deviations 1 1 0 0 2 4 7, their median 1.
        let s = summary(&[1.0, 1.0, 2.0, 2.0, 4.0, 6.0, 9.0]).unwrap();
        assert_eq!((s.median, s.mad, s.min), (2.0, 1.0, 1.0));
        // Deviations that are not absolute would have the median 0; from the mean, 18.2.
        let s = summary(&[1.0, 2.0, 3.0, 4.0, 100.0]).unwrap();
        assert_eq!((s.median, s.mad), (3.0, 1.0));
        // Deviations left in the order of the samples would give 49 here.
        let s = summary(&[100.0, 1.0, 50.0, 51.0, 52.0]).unwrap();
        assert_eq!((s.median, s.mad), (51.0, 1.0));
    }

    #[test]
    fn deviation_ignores_offset_and_follows_scale() {
        let base = [3.0, 8.0, 1.0, 7.0, 7.0, 2.0];
        let mad = summary(&base).unwrap().mad;
        assert_eq!(summary(&base.map(|x| x + 1000.0)).unwrap().mad, mad);
        assert_eq!(summary(&base.map(|x| x * 4.0)).unwrap().mad, 4.0 * mad);
        assert_eq!(summary(&[5.0; 4]).unwrap().mad, 0.0);
    }

    #[test]
    fn quantiles_interpolate() {
        let samples = [10.0, 20.0, 30.0, 40.0, 50.0];
        assert_eq!(quantile(&samples, 0.0), Some(10.0));
        assert_eq!(quantile(&samples, 1.0), Some(50.0));
        assert_eq!(quantile(&samples, 0.625), Some(35.0));
        assert_eq!(quantile(&samples, 1.5), None);
    }

    #[test]
    fn geometric_means() {
        assert!((geometric_mean(&[1.0, 4.0]).unwrap() - 2.0).abs() < 1e-12);
        assert!((geometric_mean(&[0.5, 2.0, 8.0]).unwrap() - 2.0).abs() < 1e-12);
        for bad in [&[] as &[f64], &[1.0, 0.0], &[1.0, -2.0], &[1.0, f64::NAN], &[f64::INFINITY]] {
            assert_eq!(geometric_mean(bad), None);
        }
        // Ratios and their inverses must tell the same story.
        let ratios = [0.3, 1.7, 2.9, 0.8];
        let inverse = geometric_mean(&ratios.map(|r| 1.0 / r)).unwrap();
        assert!((geometric_mean(&ratios).unwrap() * inverse - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_least_is_known_where_groups_agree() {
        let calm = vec![100.0, 103.0, 101.0];
        let busy = vec![150.0, 153.0, 151.0];
        let least = |groups: &[Vec<f64>]| least(&groups.concat());
        let known = |groups: &[Vec<f64>]| quantile(&cluster_bootstrap(groups, 1000, 1, least), 0.84).unwrap();
        assert!(known(&[calm.clone(), busy.clone(), calm.clone()]) <= 101.0);
        assert!(known(&[busy.clone(), busy.clone(), calm.clone()]) >= 150.0, "one group may be luck");
        // Told as one group, luck can't be seen.
        assert!(known(&[[busy.clone(), busy, calm].concat()]) < 150.0);
    }

    #[test]
    fn draws_of_constants_are_the_constant_and_of_nothing_none() {
        let first = |groups: &[Vec<f64>]| groups[0][0];
        assert_eq!(cluster_bootstrap(&[vec![3.0; 5], Vec::new()], 100, 7, first), [3.0; 100]);
        assert!(cluster_bootstrap(&[Vec::new()], 100, 7, first).is_empty());
    }

    #[test]
    fn draws_of_one_seed_take_the_same_groups() {
        let groups = |lengths: [usize; 3]| [0, 1, 2].map(|i| vec![f64::from(i); lengths[i as usize]]);
        let drawn = |lengths, seed| {
            let code = |groups: &[Vec<f64>]| groups.iter().fold(0.0, |code, group| 3.0 * code + group[0]);
            cluster_bootstrap(&groups(lengths), 50, seed, code)
        };
        assert_eq!(drawn([1, 1, 1], 5), drawn([4, 1, 9], 5));
        assert_ne!(drawn([1, 1, 1], 5), drawn([1, 1, 1], 6));
    }
}
