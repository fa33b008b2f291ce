//! How far a share that was seen may be from the true one.

use serde::{Deserialize, Serialize};

/// The normal quantile of 97.5 %.
const Z: f64 = 1.959_963_984_540_054;

/// A 95 % interval of a share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// The least share that is likely.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

impl Bounds {
    /// Nothing is known.
    pub const OPEN: Self = Self { low: 0.0, high: 1.0 };

    /// Of `count` seen among `of`: the rule of three where none was seen or all were (Hanley & Lippman-Hand 1983), Wilson's score
    /// interval otherwise (Wilson 1927).
    pub fn of(count: u64, of: u64) -> Self {
        if of == 0 {
            return Self::OPEN;
        }
        let n = of as f64;
        let three = (3.0 / n).min(1.0);
        if count == 0 {
            return Self { low: 0.0, high: three };
        }
        if count >= of {
            return Self { low: 1.0 - three, high: 1.0 };
        }
        let p = count as f64 / n;
        let shrink = 1.0 + Z * Z / n;
        let centre = (p + Z * Z / (2.0 * n)) / shrink;
        let half = Z / shrink * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        Self { low: (centre - half).max(0.0), high: (centre + half).min(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn textbook_values() {
        assert_eq!(Bounds::of(0, 1_000_000).high, 3e-6);
        // Newcombe 1998, table I: 81 of 263 is 0.2553 to 0.3662.
        let wilson = Bounds::of(81, 263);
        assert!((wilson.low - 0.2553).abs() < 5e-5 && (wilson.high - 0.3662).abs() < 5e-5, "{wilson:?}");
        assert_eq!(Bounds::of(0, 0), Bounds::OPEN);
        assert_eq!(Bounds::of(300, 300), Bounds { low: 0.99, high: 1.0 });
    }

    proptest! {
        #[test]
        fn what_was_seen_lies_between(count in 0u64..1000, more in 0u64..1_000_000) {
            let of = count + more;
            prop_assume!(of > 0);
            let Bounds { low, high } = Bounds::of(count, of);
            let share = count as f64 / of as f64;
            prop_assert!((0.0..=share).contains(&low) && (share..=1.0).contains(&high));
        }
    }
}
