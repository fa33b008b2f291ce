//! Orders along a Morton curve (G. M. Morton, 1966): interleaved coordinates. [`crate::keys`] sorts by them.

/// Bits of each of three coordinates in a key.
pub const BITS: u32 = 10;

/// Puts two zero bits after each of the lowest [`BITS`] bits; the others are dropped.
#[inline(always)]
pub const fn spread(v: u32) -> u32 {
    let v = v & ((1 << BITS) - 1);
    let v = (v | v << 16) & 0x0300_00ff;
    let v = (v | v << 8) & 0x0300_f00f;
    let v = (v | v << 4) & 0x030c_30c3;
    (v | v << 2) & 0x0924_9249
}

/// A key in the upper half, a number in the lower.
#[inline(always)]
pub const fn keyed(key: u32, number: u32) -> u64 {
    (key as u64) << 32 | number as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_leaves_two_bits_between() {
        for v in [0, 1, 5, 0x155, 0x3ff, 0xffc0_03ff] {
            let expected = (0..BITS).fold(0, |sum, bit| sum | (v >> bit & 1) << (3 * bit));
            assert_eq!(spread(v), expected);
        }
    }
}
