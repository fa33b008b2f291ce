//! Where the numbers of cases come from.

use scenes::Random;

/// A source of numbers that never ends.
pub trait Numbers {
    /// 32 bits.
    fn bits(&mut self) -> u32;

    /// A number below `end`, which is not 0.
    fn below(&mut self, end: u32) -> u32 {
        self.bits() % end
    }

    /// One of these.
    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u32) as usize]
    }

    /// From −1 to 1, a multiple of 2^-23.
    fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / (1 << 23) as f32 - 1.0
    }
}

impl Numbers for Random {
    fn bits(&mut self) -> u32 {
        (Self::bits(self) >> 32) as u32
    }
}

/// Numbers read from bytes; zeros behind their end.
#[derive(Clone, Debug)]
pub struct Bytes<'b>(pub &'b [u8]);

impl Numbers for Bytes<'_> {
    fn bits(&mut self) -> u32 {
        let mut word = [0; 4];
        let len = self.0.len().min(4);
        let (now, later) = self.0.split_at(len);
        word[..len].copy_from_slice(now);
        self.0 = later;
        u32::from_le_bytes(word)
    }

    /// One byte where that is enough, so that a fuzzer's changes stay small.
    fn below(&mut self, end: u32) -> u32 {
        if end > 256 {
            return self.bits() % end;
        }
        let Some((first, later)) = self.0.split_first() else { return 0 };
        self.0 = later;
        u32::from(*first) % end
    }
}
