//! Logarithmic scales and their ticks.

use super::svg::width;

/// A logarithmic scale from values to positions.
#[derive(Clone, Copy, Debug)]
pub struct Log {
    /// Powers of ten at the ends.
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Log {
    /// The scale that holds all positive finite `values` with a little room, `from … to` in
    /// positions. At least a factor of two is shown.
    pub fn around(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Self {
        let usable = values.into_iter().filter(|v| *v > 0.0 && v.is_finite()).map(f64::log10);
        let (low, high) =
            usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let (low, high) = if high - low < 2f64.log10() {
            (low - 1.5f64.log10(), high + 1.5f64.log10())
        } else {
            (low, high)
        };
        let room = (high - low) * 0.06;
        Self { low: low - room, high: high + room, from, to }
    }

    /// The position of a value; values off the scale go to its ends.
    pub fn at(&self, value: f64) -> f64 {
        let share = (value.log10().clamp(self.low, self.high) - self.low) / (self.high - self.low);
        self.from + (self.to - self.from) * share
    }

    /// The ends of the scale.
    pub fn range(&self) -> (f64, f64) {
        (10f64.powf(self.low), 10f64.powf(self.high))
    }

    /// Values worth a tick whose labels, as `label` writes them, have room beside each other on a
    /// horizontal axis or, if `vertical`, above each other.
    pub fn ticks(&self, vertical: bool, label: impl Fn(f64) -> String) -> Vec<(f64, String)> {
        // From many to few: 1-2-3-4-6-8 (for less than a decade), 1-2-5, powers of ten, every second one, …
        let steps: [&[f64]; 4] = [&[1.0, 2.0, 3.0, 4.0, 6.0, 8.0], &[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]];
        let sparse = [2, 3, 4, 5, 6, 7, 8, 16, 32, 64, 128, 256].map(|every| (steps[3], every));
        let candidates = steps.iter().map(|s| (*s, 1)).chain(sparse);
        for (mantissas, every) in candidates {
            let ticks = self.all(mantissas, every, &label);
            if ticks.len() <= 7 && self.fits(&ticks, vertical) {
                return ticks;
            }
        }
        Vec::new()
    }

    fn all(&self, mantissas: &[f64], every: i32, label: &impl Fn(f64) -> String) -> Vec<(f64, String)> {
        let exponents = self.low.floor() as i32..=self.high.ceil() as i32;
        exponents
            .filter(|e| e.rem_euclid(every) == 0)
            .flat_map(|e| mantissas.iter().map(move |m| m * 10f64.powi(e)))
            .filter(|v| (self.low..=self.high).contains(&v.log10()))
            .map(|v| (v, label(v)))
            .collect()
    }

    fn fits(&self, ticks: &[(f64, String)], vertical: bool) -> bool {
        const GAP: f64 = 8.0;
        ticks.windows(2).all(|pair| {
            let apart = (self.at(pair[1].0) - self.at(pair[0].0)).abs();
            let needed = if vertical { 18.0 } else { (width(&pair[0].1) + width(&pair[1].1)) / 2.0 + GAP };
            apart >= needed
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::units;
    use proptest::prelude::*;

    #[test]
    fn ends_and_middle() {
        let scale = Log::around([1.0, 100.0], 0.0, 100.0);
        assert!((scale.at(10.0) - 50.0).abs() < 1e-9);
        assert!(scale.at(1.0) > 0.0 && scale.at(100.0) < 100.0);
        assert_eq!(scale.at(1e-9), 0.0);
        assert!(Log::around([], 0.0, 1.0).at(3.0).is_finite());
    }

    #[test]
    fn the_widest_scale_there_can_be_has_ticks() {
        let scale = Log::around([5e-324, 1e308, f64::INFINITY, f64::NAN], 0.0, 300.0);
        assert!((10.0..20.0).contains(&scale.at(5e-324)) && (280.0..290.0).contains(&scale.at(1e308)));
        for vertical in [false, true] {
            let ticks = scale.ticks(vertical, units::time);
            assert!((2..=7).contains(&ticks.len()), "{ticks:?}");
        }
    }

    proptest! {
        #[test]
        fn ticks_do_not_touch(low in -3.0..6.0f64, decades in 0.0..9.0f64, vertical: bool) {
            let (low, high) = (10f64.powf(low), 10f64.powf(low + decades));
            let scale = Log::around([low, high], 40.0, 350.0);
            let ticks = scale.ticks(vertical, units::time);
            prop_assert!(decades < 0.5 || !ticks.is_empty());
            prop_assert!(scale.fits(&ticks, vertical));
        }
    }
}
