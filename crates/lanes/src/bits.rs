//! The bits of a word, one by one.

use crate::row::ROW;

/// Takes the lowest bit off a mask of lanes, and tells the lane; `None` once there is no lane left.
#[inline(always)]
pub fn next_lane(lanes: &mut u32) -> Option<usize> {
    let lane = lanes.trailing_zeros() as usize;
    *lanes &= lanes.wrapping_sub(1);
    // Below the lanes of a row, not only the bits of the mask: so looking a lane up in a row takes no check of bounds.
    (lane < ROW).then_some(lane)
}

/// Takes the lowest bit off a word, and tells its place; `None` once there is none left.
#[inline(always)]
pub fn next_bit(word: &mut u64) -> Option<usize> {
    if *word == 0 {
        return None;
    }
    let place = word.trailing_zeros() as usize;
    *word &= *word - 1;
    Some(place)
}

/// The places of the bits that are set, from the lowest up.
#[inline(always)]
pub fn ones(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || next_bit(&mut word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_is_taken_once_from_the_lowest_up() {
        let mut lanes = 1 << 15 | 0b1010;
        assert_eq!(next_lane(&mut lanes), Some(1));
        assert_eq!(lanes, 1 << 15 | 0b1000, "the others stay");
        assert_eq!([next_lane(&mut lanes), next_lane(&mut lanes)], [Some(3), Some(15)]);
        assert_eq!([next_lane(&mut lanes), next_lane(&mut lanes)], [None; 2]);
        assert_eq!(lanes, 0);
        let mut all = u32::MAX >> (32 - ROW);
        assert!(std::iter::from_fn(|| next_lane(&mut all)).eq(0..ROW));
    }

    #[test]
    fn every_bit_is_taken_once_from_the_lowest_up() {
        let mut word = 1 << 63 | 1;
        assert_eq!(next_bit(&mut word), Some(0));
        assert_eq!(word, 1 << 63, "the other stays");
        assert_eq!([next_bit(&mut word), next_bit(&mut word), next_bit(&mut word)], [Some(63), None, None]);
        assert_eq!(word, 0);
    }

    #[test]
    fn every_bit_is_told_once_from_the_lowest_up() {
        assert_eq!(ones(0).count(), 0);
        assert_eq!(ones(1 << 63 | 0b1010).collect::<Vec<_>>(), [1, 3, 63]);
        assert!(ones(u64::MAX).eq(0..64));
    }
}
