//! Objects that a ray meets in several cells.

/// Puts what stands in the list from place `first` on in order, each number once.
pub fn keep_once(found: &mut Vec<u32>, first: usize) {
    let mut met = found.split_off(first);
    met.sort_unstable();
    met.dedup();
    found.append(&mut met);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stood_there_before_is_left_alone() {
        let mut found = vec![7, 7, 3, 9, 3, 7, 9];
        keep_once(&mut found, 2);
        assert_eq!(found, [7, 7, 3, 7, 9]);
    }
}
