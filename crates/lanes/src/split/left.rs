//! What may be divided where.

use super::item::Item;

/// What a split leaves on its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// Any number of items.
    Any,
    /// Any number, but the cost of a part counts its weight in packets of so many.
    Packed(usize),
    /// A whole number of packets of so many items; each item weighs 1.
    Whole(usize),
}

/// What a division overwrites.
pub struct Scratch<'a> {
    /// Room for as many items.
    pub items: &'a mut [Item],
    /// A byte for each.
    pub marks: &'a mut [u8],
}

impl Scratch<'_> {
    /// That of so many items, which it has no more.
    ///
    /// # Panics
    /// If it has less.
    pub fn take(&mut self, items: usize) -> Self {
        let marks = self.marks.split_off_mut(..items).expect("a mark for each");
        Self { items: self.items.split_off_mut(..items).expect("room for all"), marks }
    }
}
