//! The generators' source of random numbers: SplitMix64 (Steele, Lea & Flood 2014,
//! <https://doi.org/10.1145/2714064.2660195>), integers and basic arithmetic only, so that
//! every platform draws the same scene.

use glam::DVec3;

/// A reproducible stream of random numbers.
#[derive(Clone, Debug)]
pub struct Random(u64);

/// SplitMix64's finaliser: a well-mixed 64-bit hash of `x`.
pub fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

impl Random {
    /// The stream that belongs to `seed`.
    pub fn new(seed: u64) -> Self {
        Self(mix(seed ^ 0x5ca1_ab1e_0ddb_a115))
    }

    /// The stream of SplitMix64 itself, which other programs draw from the same state.
    pub fn from_state(state: u64) -> Self {
        Self(state)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [`low`, `high`).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform over the integers below `end`, which must not be 0.
    pub fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.bits()) * end as u128) >> 64) as usize
    }

    /// Uniform in the cube [`low`, `high`)³.
    pub fn in_cube(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.range(low, high), self.range(low, high), self.range(low, high))
    }

    /// Uniform on the unit sphere, by rejection: needs a square root and no trigonometry.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.in_cube(-1.0, 1.0);
            let square = p.length_squared();
            if (1e-4..=1.0).contains(&square) {
                return p / square.sqrt();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_never_changes() {
        let mut random = Random::new(1);
        let drawn = [random.bits(), random.bits()];
        let mut again = Random::new(1);
        assert_eq!(drawn, [again.bits(), again.bits()]);
        assert_ne!(drawn[0], Random::new(2).bits());
    }

    #[test]
    fn the_stream_is_splitmix64() {
        let mut random = Random::from_state(1_234_567);
        let drawn: [u64; 3] = std::array::from_fn(|_| random.bits());
        assert_eq!(drawn, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }

    #[test]
    fn draws_fill_their_range() {
        let mut random = Random::new(7);
        let mean = (0..10_000).map(|_| random.range(2.0, 4.0)).sum::<f64>() / 1e4;
        assert!((mean - 3.0).abs() < 0.05, "{mean}");
        let sum = (0..10_000).map(|_| random.direction()).sum::<DVec3>() / 1e4;
        assert!(sum.length() < 0.05, "{sum}");
        assert!((0..100).all(|_| random.below(3) < 3));
    }
}
