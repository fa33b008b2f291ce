//! Logarithmic scales and their ticks.

use super::svg::width;

/// A logarithmic scale from values to positions.
#[derive(Clone, Copy, Debug)]
pub struct Log {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Log {
    /// The scale that holds all positive finite `values` with a little room, `from … to` in
    /// positions. At least a factor of two is shown.
    pub fn around(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Self {
        let usable = values.into_iter().filter(|v| *v > 0.0 && v.is_finite());
        let (low, high) = usable.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 10.0) };
        let (low, high) = if high / low < 2.0 { (low / 1.5, high * 1.5) } else { (low, high) };
        let room = (high / low).powf(0.06);
        Self { low: low / room, high: high * room, from, to }
    }

    /// The position of a value; values off the scale go to its ends.
    pub fn at(&self, value: f64) -> f64 {
        let share = (value.clamp(self.low, self.high) / self.low).ln() / (self.high / self.low).ln();
        self.from + (self.to - self.from) * share
    }

    /// The ends of the scale.
    pub const fn range(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// Values worth a tick whose labels, as `label` writes them, have room beside each other on a
    /// horizontal axis or, if `vertical`, above each other.
    pub fn ticks(&self, vertical: bool, label: impl Fn(f64) -> String) -> Vec<(f64, String)> {
        // From many to few: 1-2-3-4-6-8 (for less than a decade), 1-2-5, powers of ten, every second one, …
        let steps: [&[f64]; 4] = [&[1.0, 2.0, 3.0, 4.0, 6.0, 8.0], &[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]];
        let candidates = steps.iter().map(|s| (*s, 1)).chain((2..=8).map(|every| (steps[3], every)));
        for (mantissas, every) in candidates {
            let ticks = self.all(mantissas, every, &label);
            if ticks.len() <= 7 && self.fits(&ticks, vertical) {
                return ticks;
            }
        }
        Vec::new()
    }

    fn all(&self, mantissas: &[f64], every: i32, label: &impl Fn(f64) -> String) -> Vec<(f64, String)> {
        let exponents = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
        exponents
            .filter(|e| e.rem_euclid(every) == 0)
            .flat_map(|e| mantissas.iter().map(move |m| m * 10f64.powi(e)))
            .filter(|v| (self.low..=self.high).contains(v))
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

/// A number of four digits at most, with `k`, `M`, `G` for thousands.
pub fn short(value: f64) -> String {
    let (value, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    format!("{}{unit}", trimmed(value))
}

/// Up to three digits that count, without zeros at the end.
pub fn trimmed(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
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
    fn numbers_are_short() {
        for (v, text) in
            [(0.05, "0.05"), (1.0, "1"), (20.0, "20"), (1500.0, "1.5k"), (2e6, "2M"), (1.234e9, "1.23G")]
        {
            assert_eq!(short(v), text);
        }
    }

    proptest! {
        #[test]
        fn ticks_do_not_touch(low in -3.0..6.0f64, decades in 0.0..9.0f64, vertical: bool) {
            let (low, high) = (10f64.powf(low), 10f64.powf(low + decades));
            let scale = Log::around([low, high], 40.0, 350.0);
            let ticks = scale.ticks(vertical, harness::units::time);
            prop_assert!(decades < 0.5 || !ticks.is_empty());
            prop_assert!(scale.fits(&ticks, vertical));
        }
    }
}
