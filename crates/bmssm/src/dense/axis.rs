//! Bit maps of the slices of one direction.

use accel::BuildError;
use std::ops::Range;

/// A bit for each slice and object: does the slice touch the object (ⁱR, ʲS or ᵏT of Skala 1993, §2, §5).
///
/// Each slice's map begins at a word; what is left of its last word is zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    objects: usize,
    slices: usize,
    words: Vec<u64>,
}

impl Axis {
    /// Maps in which no slice touches any object.
    ///
    /// # Panics
    /// If memory doesn't hold them.
    pub fn new(slices: usize, objects: usize) -> Self {
        Self::try_new(slices, objects).unwrap_or_else(|error| panic!("{error}"))
    }

    /// As [`Axis::new`].
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if memory doesn't hold them.
    pub fn try_new(slices: usize, objects: usize) -> Result<Self, BuildError> {
        let len = slices * words_of(objects);
        let mut words = accel::reserved(super::ID, len)?;
        words.resize(len, 0);
        Ok(Self { objects, slices, words })
    }

    /// Bytes of the maps of so many slices and objects: their bits, rounded up to words of 64.
    pub const fn bytes_of(slices: usize, objects: usize) -> u128 {
        slices as u128 * words_of(objects) as u128 * 8
    }

    /// Number of slices.
    pub fn len(&self) -> usize {
        self.slices
    }

    /// Whether there is no slice.
    pub fn is_empty(&self) -> bool {
        self.slices == 0
    }

    /// Number of objects, p in the paper.
    pub fn objects(&self) -> usize {
        self.objects
    }

    /// Says that all slices of a range touch an object.
    ///
    /// # Panics
    /// If there is no such object or slice.
    pub fn touch(&mut self, slices: Range<u32>, object: u32) {
        assert!((object as usize) < self.objects, "object {object} of {}", self.objects);
        assert!(slices.end as usize <= self.slices, "slice {} of {}", slices.end, self.slices);
        let words = words_of(self.objects);
        // Not by index: compiled for AVX-512 by rustc 1.95 and inlined, that loop sets wrong bits (docs/reliability.md).
        for slice in self.words.chunks_exact_mut(words).take(slices.end as usize).skip(slices.start as usize)
        {
            slice[object as usize / 64] |= 1 << (object % 64);
        }
    }

    /// A slice's map: bit `object % 64` of word `object / 64`.
    ///
    /// # Panics
    /// If there is no such slice.
    #[inline]
    pub fn slice(&self, slice: u32) -> &[u64] {
        let words = words_of(self.objects);
        &self.words[slice as usize * words..][..words]
    }

    /// The objects that at least one slice touches: the OR of all maps, V or W in Skala 1993, §2.
    pub fn coverage(&self) -> Vec<u64> {
        let mut all = vec![0; words_of(self.objects)];
        for slice in 0..self.slices as u32 {
            for (all, word) in all.iter_mut().zip(self.slice(slice)) {
                *all |= word;
            }
        }
        all
    }

    /// Words of a slice's map.
    pub fn words(&self) -> usize {
        words_of(self.objects)
    }

    /// The maps above: a bit for each word of each slice's map, set where the word holds any.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if memory doesn't hold them.
    pub fn above(&self) -> Result<Self, BuildError> {
        let mut above = Self::try_new(self.slices, self.words())?;
        for slice in 0..self.slices as u32 {
            for (index, _) in self.slice(slice).iter().enumerate().filter(|(_, word)| **word != 0) {
                above.touch(slice..slice + 1, index as u32);
            }
        }
        Ok(above)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        accel::vec_bytes(&self.words)
    }
}

const fn words_of(objects: usize) -> usize {
    objects.div_ceil(64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_holds_the_objects_that_were_touched() {
        let mut axis = Axis::new(3, 130);
        axis.touch(1..3, 0);
        axis.touch(2..3, 129);
        axis.touch(0..0, 64);
        assert_eq!(axis.slice(0), [0, 0, 0]);
        assert_eq!(axis.slice(1), [1, 0, 0]);
        assert_eq!(axis.slice(2), [1, 0, 2]);
        assert_eq!(axis.coverage(), [1, 0, 2]);
    }

    /// Skala 1993, §3: (n + m)·p bits; §5: 3·N·p bits.
    #[test]
    fn bytes_are_a_bit_for_each_slice_and_object_up_to_word_padding() {
        for (slices, objects) in [(256, 640), (256, 6300), (8, 1), (64, 0)] {
            let axis = Axis::new(slices, objects);
            let bits = slices * objects;
            assert_eq!(axis.bytes() as u128, Axis::bytes_of(slices, objects));
            assert!(axis.bytes() * 8 >= bits && axis.bytes() * 8 < bits + 64 * slices + 1);
            if objects % 64 == 0 {
                assert_eq!(axis.bytes() * 8, bits);
            }
        }
    }
}
