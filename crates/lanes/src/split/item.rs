//! What is split: boxes with numbers and weights.

use super::UnitBox;

/// A box, the number of what is in it, and how many objects that is.
///
/// The fourth of the least coordinates are the number's bits, the fourth of the greatest the weight's.
#[derive(Clone, Copy, Debug)]
pub struct Item(pub Extremes);

impl Item {
    /// Nothing.
    pub const EMPTY: Self = Self(Extremes::NONE);

    /// A box with its number and weight.
    #[inline(always)]
    pub fn new(number: u32, weight: u32, UnitBox { min, max }: &UnitBox) -> Self {
        Self(Extremes {
            low: [min[0], min[1], min[2], f32::from_bits(number)],
            high: [-max[0], -max[1], -max[2], f32::from_bits(weight)],
        })
    }

    /// The number.
    #[inline(always)]
    pub fn number(&self) -> u32 {
        self.0.low[3].to_bits()
    }

    /// How many objects it stands for.
    #[inline(always)]
    pub fn weight(&self) -> u32 {
        self.0.high[3].to_bits()
    }

    /// The box.
    #[inline(always)]
    pub fn bounds(&self) -> UnitBox {
        self.0.bounds()
    }

    /// Twice the centre.
    #[inline(always)]
    pub fn center(&self, axis: usize) -> f32 {
        self.0.low[axis] - self.0.high[axis]
    }

    /// Twice the centre, with the sign changed in the second.
    #[inline(always)]
    pub fn centers(&self) -> Extremes {
        let Extremes { low: a, high: b } = &self.0;
        let center = [a[0] - b[0], a[1] - b[1], a[2] - b[2], 0.0];
        Extremes { low: center, high: center.map(|v| -v) }
    }

    /// The box as it is gathered.
    #[inline(always)]
    pub fn extremes(&self) -> Extremes {
        self.0
    }
}

/// The range of what was gathered. The fourth numbers mean nothing but in an [`Item`].
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Extremes {
    /// Least coordinates.
    pub low: [f32; 4],
    /// Greatest coordinates with their signs changed, so that one minimum serves both ends.
    pub high: [f32; 4],
}

impl Extremes {
    /// Of nothing.
    pub const NONE: Self = Self { low: [f32::INFINITY; 4], high: [f32::INFINITY; 4] };

    /// Adds what another range holds, both of numbers that are not negative.
    ///
    /// Bits of such numbers are ordered as they are, and those of their negatives the other way round. Compared as
    /// floats, this becomes a masked store where it goes to memory, and waits for the store before.
    #[inline(always)]
    pub fn gather(&mut self, other: &Self) {
        for lane in 0..4 {
            let (low, high) = (self.low[lane].to_bits(), self.high[lane].to_bits());
            self.low[lane] = f32::from_bits(low.min(other.low[lane].to_bits()));
            self.high[lane] = f32::from_bits(high.max(other.high[lane].to_bits()));
        }
    }

    /// Adds what another range of any numbers holds.
    #[inline(always)]
    pub fn gather_signed(&mut self, other: &Self) {
        for lane in 0..4 {
            let [low, high] = [other.low[lane], other.high[lane]];
            self.low[lane] = if low < self.low[lane] { low } else { self.low[lane] };
            self.high[lane] = if high < self.high[lane] { high } else { self.high[lane] };
        }
    }

    /// The box of all boxes.
    #[inline(always)]
    pub fn of(items: &[Item]) -> Self {
        let mut all = Self::NONE;
        for item in items {
            all.gather(&item.extremes());
        }
        all
    }

    /// As a box.
    #[inline(always)]
    pub fn bounds(&self) -> UnitBox {
        let Self { low, high } = self;
        UnitBox { min: [low[0], low[1], low[2]], max: [-high[0], -high[1], -high[2]] }
    }
}

/// A number from 0 to 2²² rounded, in fewer instructions than a conversion that minds everything.
#[inline(always)]
pub fn whole(number: f32) -> u32 {
    (number + (1u32 << 23) as f32).to_bits() & ((1 << 23) - 1)
}
