//! Sorting the 64 objects of a block.

use crate::BLOCK;

/// The place of each in their order, equal ones as they come.
///
/// By counting who comes before whom: that takes lanes and no branch, which a sort of so few can't foresee. Keys are below [`i32::MAX`].
#[inline(always)]
pub fn ranks(keys: &[i32; BLOCK]) -> [u32; BLOCK] {
    let mut ranks = [0; BLOCK];
    // Those not yet passed come after an equal one.
    let mut ends = *keys;
    for end in &mut ends {
        *end += 1;
    }
    for (i, key) in keys.iter().enumerate() {
        ends[i] = *key;
        for (rank, end) in ranks.iter_mut().zip(&ends) {
            *rank += u32::from(key < end);
        }
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ranks_are_those_of_a_stable_sort(depths in prop::collection::vec(0..40i32, 0..=BLOCK)) {
            let mut padded = [i32::MAX - 1; BLOCK];
            padded[..depths.len()].copy_from_slice(&depths);
            let mut places: Vec<usize> = (0..BLOCK).collect();
            places.sort_by_key(|i| padded[*i]);
            let ranks = ranks(&padded);
            prop_assert!(places.into_iter().enumerate().all(|(rank, i)| ranks[i] as usize == rank));
        }
    }
}
