//! The numbers of packed objects in as few bytes as they need.

use crate::EMPTY_SLOT;
use accel::BuildError;
use accel::parallel::prelude::*;

/// Numbers by slot: three bytes each where all are below 2²⁴ − 1, else four.
#[derive(Clone, Debug)]
pub struct Ids {
    bytes: Vec<u8>,
    wide: bool,
}

/// [`EMPTY_SLOT`] in three bytes.
const EMPTY_SHORT: u32 = EMPTY_SLOT >> 8;

impl Ids {
    /// Slot i holds `order[i]`.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory.
    pub fn new(structure: &str, order: &[u32]) -> Result<Self, BuildError> {
        const TASK: usize = 1 << 14;
        let wide =
            order.par_chunks(TASK).any(|ids| ids.iter().any(|id| (EMPTY_SHORT..EMPTY_SLOT).contains(id)));
        let width = if wide { 4 } else { 3 };
        let mut bytes = accel::zeroed(structure, order.len() * width)?;
        bytes.par_chunks_mut(TASK * width).zip(order.par_chunks(TASK)).for_each(|(bytes, ids)| {
            for (bytes, id) in bytes.chunks_exact_mut(width).zip(ids) {
                bytes.copy_from_slice(&id.to_le_bytes()[..width]);
            }
        });
        Ok(Self { bytes, wide })
    }

    /// The number in a slot, or [`EMPTY_SLOT`].
    #[inline(always)]
    pub fn get(&self, slot: usize) -> u32 {
        if self.wide {
            return u32::from_le_bytes(*self.bytes[4 * slot..].first_chunk().expect("a slot that there is"));
        }
        let [a, b, c] = *self.bytes[3 * slot..].first_chunk().expect("a slot that there is");
        let id = u32::from_le_bytes([a, b, c, 0]);
        if id == EMPTY_SHORT { EMPTY_SLOT } else { id }
    }

    /// Whether there is no slot.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.bytes.len() / if self.wide { 4 } else { 3 }
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        accel::vec_bytes(&self.bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_whatever_their_width() {
        for (order, width) in [
            (vec![0, 7, EMPTY_SHORT - 1, EMPTY_SLOT], 3),
            (vec![EMPTY_SHORT, 1, EMPTY_SLOT], 4),
            (vec![EMPTY_SLOT - 1, EMPTY_SLOT], 4),
            (vec![], 3),
        ] {
            let ids = Ids::new("x", &order).unwrap();
            assert_eq!(ids.len(), order.len());
            assert_eq!(ids.bytes(), order.len() * width);
            assert!(order.iter().enumerate().all(|(slot, id)| ids.get(slot) == *id), "{order:?}");
        }
    }
}
