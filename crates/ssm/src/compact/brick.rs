//! A brick of 4×4×4 cells.

/// Cells along an edge of a brick.
pub(super) const EDGE: u32 = 4;
/// Two to this is [`EDGE`].
pub(super) const SHIFT: u32 = 2;
/// Cells of a brick.
pub(super) const BRICK: usize = 64;

/// The number of a cell within its brick.
#[inline(always)]
pub(super) fn within([x, y, z]: [u32; 3]) -> u32 {
    x % EDGE + y % EDGE * EDGE + z % EDGE * (EDGE * EDGE)
}

/// The cell of that number within a brick that is at this place among those of its size.
#[inline(always)]
pub(super) fn cell_of([x, y, z]: [u32; 3], within: u32) -> [u32; 3] {
    [x * EDGE + within % EDGE, y * EDGE + within / EDGE % EDGE, z * EDGE + within / (EDGE * EDGE)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbered_within_their_brick() {
        for number in 0..BRICK as u32 {
            let cell = cell_of([5, 0, 2], number);
            assert_eq!(cell.map(|slice| slice / EDGE), [5, 0, 2]);
            assert_eq!(within(cell), number);
        }
    }
}
