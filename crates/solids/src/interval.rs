//! Interval arithmetic in `f64`, rounded outward.

use accel::solid::Arithmetic;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// All numbers from `low` to `high`, which may be infinite. What a function of numbers in it can be is in the function of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

/// Beyond this, sines and cosines are taken for anything: their argument is hardly known.
const FAR: f64 = 1e6;

impl Interval {
    /// All numbers.
    pub const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// One number.
    pub const fn point(value: f64) -> Self {
        Self { low: value, high: value }
    }

    /// From one number to another.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// A result that was rounded to nearest, moved outward to the next number; what is no number may be any.
    fn outward(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self { low: low.next_down(), high: high.next_up() }
    }

    /// As [`Interval::outward`] for functions that err by less than a unit in the last place.
    fn further(low: f64, high: f64) -> Self {
        let Self { low, high } = Self::outward(low, high);
        Self::outward(low, high)
    }

    /// Whether 0 is among them.
    pub fn holds_zero(self) -> bool {
        self.low <= 0.0 && 0.0 <= self.high
    }

    /// How far apart the ends are.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// What is in both, or the first where nothing is.
    pub fn within(self, other: Self) -> Self {
        let both = Self { low: self.low.max(other.low), high: self.high.min(other.high) };
        if both.low <= both.high { both } else { self }
    }

    /// All numbers from the least to the greatest of both.
    fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Those of an increasing function that errs by less than a unit in the last place.
    fn increasing(self, function: impl Fn(f64) -> f64) -> Self {
        Self::further(function(self.low), function(self.high))
    }

    /// sin, whose maximum is at `peak` and every τ from there.
    fn wave(self, peak: f64, function: impl Fn(f64) -> f64) -> Self {
        let far = !(self.low.abs() <= FAR && self.high.abs() <= FAR);
        if far || self.width() >= TAU {
            return Self { low: -1.0, high: 1.0 };
        }
        // Whether one of these lies inside, give or take what places up to FAR are rounded by.
        let meets = |at: f64| {
            let slack = 1e-9;
            let next = ((self.low - slack - at) / TAU).ceil() * TAU + at;
            next <= self.high + slack
        };
        let (a, b) = (function(self.low), function(self.high));
        let Self { low, high } = Self::further(a.min(b), a.max(b));
        Self {
            low: if meets(peak + PI) { -1.0 } else { low.max(-1.0) },
            high: if meets(peak) { 1.0 } else { high.min(1.0) },
        }
    }
}

/// 0·∞ is 0: an end that is infinite stands for numbers as large as you like.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// valueⁿ rounded up or down, by squares as plain numbers are.
fn power_outward(value: f64, n: u32, up: bool) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let sign = if value < 0.0 && n % 2 == 1 { -1.0 } else { 1.0 };
    let grows = (sign > 0.0) == up;
    let outward = |size: f64| if grows { size.next_up() } else { size.next_down().max(0.0) };
    let (mut result, mut square, mut n) = (1.0, value.abs(), n);
    while n > 0 {
        if n & 1 == 1 {
            result = outward(result * square);
        }
        n >>= 1;
        if n > 0 {
            square = outward(square * square);
        }
    }
    result * sign
}

impl Arithmetic for Interval {
    fn constant(value: f64) -> Self {
        Self::point(value)
    }
    fn add(self, other: Self) -> Self {
        Self::outward(self.low + other.low, self.high + other.high)
    }
    fn sub(self, other: Self) -> Self {
        Self::outward(self.low - other.high, self.high - other.low)
    }
    fn mul(self, other: Self) -> Self {
        let all = [
            product(self.low, other.low),
            product(self.low, other.high),
            product(self.high, other.low),
            product(self.high, other.high),
        ];
        let low = all.into_iter().fold(f64::INFINITY, f64::min);
        let high = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self::outward(low, high)
    }
    fn div(self, other: Self) -> Self {
        if other.holds_zero() {
            return Self::ALL;
        }
        self.mul(Self::outward(1.0 / other.high, 1.0 / other.low))
    }
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
    fn power(self, n: u32) -> Self {
        if n == 0 {
            return Self::point(1.0);
        }
        let base = if n.is_multiple_of(2) { Arithmetic::abs(self) } else { self };
        let (low, high) = (power_outward(base.low, n, false), power_outward(base.high, n, true));
        if low.is_nan() || high.is_nan() { Self::ALL } else { Self { low, high } }
    }
    fn sqrt(self) -> Self {
        // Correctly rounded.
        let Self { low, high } = Self::outward(self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        Self { low: low.max(0.0), high }
    }
    fn abs(self) -> Self {
        if self.low >= 0.0 {
            return self;
        }
        if self.high <= 0.0 {
            return self.neg();
        }
        Self { low: 0.0, high: self.high.max(-self.low) }
    }
    fn exp(self) -> Self {
        let Self { low, high } = self.increasing(libm::exp);
        Self { low: low.max(0.0), high }
    }
    fn ln(self) -> Self {
        self.increasing(|value| libm::log(value.max(0.0)))
    }
    fn sin(self) -> Self {
        self.wave(FRAC_PI_2, libm::sin)
    }
    fn cos(self) -> Self {
        self.wave(0.0, libm::cos)
    }
    fn min(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }
    fn max(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }
}

/// What a function can be over an interval of t, and what its derivative can be. Where there is none, as of |a| at 0, it holds the
/// derivatives from both sides, and the mean value theorem with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The values.
    pub value: Interval,
    /// The derivatives.
    pub slope: Interval,
}

impl Slope {
    fn through(self, value: Interval, slope: Interval) -> Self {
        Self { value, slope: self.slope.mul(slope) }
    }
}

impl Arithmetic for Slope {
    fn constant(value: f64) -> Self {
        Self { value: Interval::point(value), slope: Interval::point(0.0) }
    }
    fn add(self, other: Self) -> Self {
        Self { value: self.value.add(other.value), slope: self.slope.add(other.slope) }
    }
    fn sub(self, other: Self) -> Self {
        Self { value: self.value.sub(other.value), slope: self.slope.sub(other.slope) }
    }
    fn mul(self, other: Self) -> Self {
        let slope = self.slope.mul(other.value).add(other.slope.mul(self.value));
        Self { value: self.value.mul(other.value), slope }
    }
    fn div(self, other: Self) -> Self {
        let value = self.value.div(other.value);
        let slope = self.slope.sub(other.slope.mul(value)).div(other.value);
        Self { value, slope }
    }
    fn neg(self) -> Self {
        Self { value: self.value.neg(), slope: self.slope.neg() }
    }
    fn power(self, n: u32) -> Self {
        if n == 0 {
            return Self::constant(1.0);
        }
        let slope = self.value.power(n - 1).mul(Interval::point(f64::from(n)));
        self.through(self.value.power(n), slope)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        if self.value.high <= 0.0 {
            return Self::constant(0.0);
        }
        let steep = Interval::point(0.5).div(root);
        let steep = if root.low > 0.0 { steep } else { Interval { low: 0.0, high: f64::INFINITY } };
        self.through(root, steep)
    }
    fn abs(self) -> Self {
        let low = if self.value.low > 0.0 { 1.0 } else { -1.0 };
        let high = if self.value.high < 0.0 { -1.0 } else { 1.0 };
        self.through(self.value.abs(), Interval { low, high })
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.through(value, value)
    }
    fn ln(self) -> Self {
        let slope = if self.value.low > 0.0 { Interval::point(1.0).div(self.value) } else { Interval::ALL };
        self.through(self.value.ln(), slope)
    }
    fn sin(self) -> Self {
        self.through(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.through(self.value.cos(), self.value.sin().neg())
    }
    fn min(self, other: Self) -> Self {
        if self.value.high < other.value.low {
            return self;
        }
        if other.value.high < self.value.low {
            return other;
        }
        Self { value: self.value.min(other.value), slope: self.slope.hull(other.slope) }
    }
    fn max(self, other: Self) -> Self {
        self.neg().min(other.neg()).neg()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::solid::Expression;
    use proptest::prelude::*;

    /// Every function that there is, over places where it is not monotone.
    const FUNCTIONS: [&str; 14] = [
        "x + y*z",
        "x - y/z",
        "x*x - y^3 + z^4",
        "(x - y)^7",
        "sqrt(x)",
        "abs(x*y) - z",
        "exp(x - z)",
        "ln(x)",
        "sin(3*x + y)",
        "cos(x*y*4)",
        "min(x, y, z)",
        "max(x*x, y)",
        "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)",
        "(x^2 + 9/4*y^2 + z^2 - 1)^3 - x^2*z^3 - 9/80*y^2*z^3",
    ];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn values_lie_within(
            function in prop::sample::select(FUNCTIONS.to_vec()),
            ends in [[-4.0f64..4.0, 0.0..2.0], [-4.0f64..4.0, 0.0..2.0], [-4.0f64..4.0, 0.0..2.0]],
            places in [0.0f64..=1.0, 0.0..=1.0, 0.0..=1.0],
            small in any::<bool>(),
        ) {
            let f = Expression::parse(function).unwrap();
            let factor = if small { 1e-9 } else { 1.0 };
            let of = ends.map(|[low, width]| Interval { low, high: low + width * factor });
            let at = [0, 1, 2].map(|i| (of[i].low + (of[i].high - of[i].low) * places[i]).min(of[i].high));
            let (value, range) = (f.value(at), f.value(of));
            prop_assert!(value.is_nan() || (range.low <= value && value <= range.high), "{} of {:?}: {} not in {:?}", function, at, value, range);
        }

        /// Between two places of a line, the mean slope is among the slopes.
        #[test]
        fn slopes_lie_within(
            function in prop::sample::select(FUNCTIONS.to_vec()),
            from in [-2.0f64..2.0, -2.0..2.0, -2.0..2.0],
            along in [-1.0f64..1.0, -1.0..1.0, -1.0..1.0],
            ts in [0.0f64..1.0, 0.0..1.0],
        ) {
            let f = Expression::parse(function).unwrap();
            let (a, b) = (ts[0].min(ts[1]), ts[0].max(ts[1]));
            prop_assume!(b - a > 1e-3);
            let line = |t: f64| [0, 1, 2].map(|i| from[i] + along[i] * t);
            let t = Interval { low: a, high: b };
            let over = [0, 1, 2].map(|i| Slope {
                value: Interval::point(from[i]).add(Interval::point(along[i]).mul(t)),
                slope: Interval::point(along[i]),
            });
            let mean = (f.value(line(b)) - f.value(line(a))) / (b - a);
            let Interval { low, high } = f.value(over).slope;
            let slack = 1e-9 * (1.0 + mean.abs());
            prop_assert!(!mean.is_finite() || (low - slack <= mean && mean <= high + slack), "{}: {} not in [{}, {}]", function, mean, low, high);
        }
    }
}
