//! `f32` values as integers over a common power of two.

use num_bigint::BigInt;

/// Splits a finite `value` into (m, e) with value = m·2^e and m odd, or (0, 0).
pub(super) fn split(value: f32) -> (i64, i32) {
    let bits = value.to_bits();
    let biased = ((bits >> 23) & 0xff) as i32;
    let fraction = i64::from(bits & 0x7f_ffff);
    let (magnitude, exponent) = match biased {
        0 => (fraction, -149),
        _ => (fraction | 0x80_0000, biased - 150),
    };
    if magnitude == 0 {
        return (0, 0);
    }
    let zeros = magnitude.trailing_zeros();
    let odd = magnitude >> zeros;
    let signed = if bits >> 31 == 1 { -odd } else { odd };
    (signed, exponent + zeros as i32)
}

/// All `values` as integers in units of 2^e, with the greatest such e; e is 0 when
/// all of them are zero. The values are finite.
pub(super) fn common_exponent<const N: usize>(values: [f32; N]) -> ([BigInt; N], i32) {
    let parts = values.map(split);
    let exponent = parts.iter().filter(|(m, _)| *m != 0).map(|(_, e)| *e).min().unwrap_or(0);
    let integers = parts.map(|(m, e)| if m == 0 { BigInt::ZERO } else { BigInt::from(m) << (e - exponent) });
    (integers, exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn split_gives_the_value_back() {
        for value in
            [1.0, -0.75, f32::MAX, f32::MIN_POSITIVE, f32::from_bits(1), -f32::from_bits(6), 1e-40, 3.3e7]
        {
            let (m, e) = split(value);
            assert_eq!(m as f64 * 2f64.powi(e), f64::from(value));
            assert_eq!(m & 1, 1);
        }
        assert_eq!((split(0.0), split(-0.0)), ((0, 0), (0, 0)));
    }

    #[test]
    fn the_whole_range_of_f32_fits_one_exponent() {
        let ([great, least, zero], exponent) = common_exponent([f32::MAX, f32::from_bits(1), 0.0]);
        assert_eq!(exponent, -149);
        assert_eq!(great, BigInt::from(0xff_ffff) << (149 + 104));
        assert_eq!((least, zero), (BigInt::from(1), BigInt::ZERO));
    }
}
