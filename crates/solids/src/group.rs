//! The objects of one kind among the slots of an order.

use crate::objects::Solids;
use crate::rows::{MAX_ROWS, Packing};
use accel::{BuildError, vec_bytes};
use lanes::{BLOCK, EMPTY_SLOT, ROW, Row, Simd};
use std::marker::PhantomData;

/// Rows of one kind. Where an order keeps kinds apart there is little that is empty in them.
#[derive(Clone, Debug)]
pub struct Kind<K> {
    rows: Vec<Row>,
    /// For each row of slots which of them hold objects of the kind, and where its group is. Empty without any.
    places: Vec<Place>,
    kind: PhantomData<K>,
}

/// Where a row's objects of a kind are.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    mask: u32,
    group: u32,
}

/// The objects of a kind in a row of slots.
#[derive(Clone, Copy, Debug)]
pub struct Group<'a> {
    /// The slots that hold them.
    pub mask: u32,
    /// Their numbers, or none.
    pub rows: &'a [Row],
}

/// `LANES` slots of a row that are tested at once.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// The numbers of the row's objects.
    pub rows: &'a [Row],
    /// Where the part begins in the row.
    pub lane: usize,
    /// The slot that it begins with.
    pub slot: usize,
    /// Which of its slots are wanted, at least one.
    pub wanted: u32,
}

/// A slot that holds an object of a kind.
#[derive(Clone, Copy, Debug)]
pub struct Slot<'a> {
    /// The numbers of its row's objects.
    pub rows: &'a [Row],
    /// Its number.
    pub slot: usize,
}

impl Slot<'_> {
    /// Its place in the row.
    #[inline(always)]
    pub fn lane(&self) -> usize {
        self.slot % ROW
    }
}

impl<'a> Group<'a> {
    /// The parts that hold wanted objects, where `slot` is the row's first.
    #[inline(always)]
    pub fn parts<S: Simd>(self, slot: usize, wanted: u32) -> impl Iterator<Item = Part<'a>> {
        let (wanted, all) = (wanted & self.mask, u32::MAX >> (32 - S::LANES));
        let part =
            move |lane| Part { rows: self.rows, lane, slot: slot + lane, wanted: wanted >> lane & all };
        (0..ROW).step_by(S::LANES).map(part).filter(|part| part.wanted != 0)
    }
}

impl<K: Packing> Kind<K> {
    /// Those of the objects in an order that are of this kind.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory.
    pub fn new(solids: &Solids<'_>, structure: &str, order: &[u32]) -> Result<Self, BuildError> {
        let mut rows: Vec<Row> = Vec::new();
        let mut places = accel::reserved(structure, order.len().div_ceil(ROW))?;
        for slots in order.chunks(ROW) {
            let (mut mask, group) = (0, rows.len() / K::ROWS);
            for (lane, object) in slots.iter().enumerate().filter(|(_, object)| **object != EMPTY_SLOT) {
                let Some(numbers) = solids.numbers::<K>(*object) else { continue };
                if mask == 0 {
                    for _ in 0..K::ROWS {
                        accel::append(structure, &mut rows, Row([0.0; ROW]))?;
                    }
                }
                mask |= 1 << lane;
                write(&mut rows[group * K::ROWS..], &numbers[..K::ROWS], lane);
            }
            places.push(Place { mask, group: group as u32 });
        }
        if rows.is_empty() {
            places = Vec::new();
        }
        rows.shrink_to_fit();
        Ok(Self { rows, places, kind: PhantomData })
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        vec_bytes(&self.rows) + vec_bytes(&self.places)
    }

    /// The slots of a block that hold objects of the kind.
    #[inline(always)]
    pub fn block(&self, block: usize) -> u64 {
        let first = block * (BLOCK / ROW);
        let places = self.places.iter().skip(first).take(BLOCK / ROW);
        places.enumerate().fold(0, |all, (row, place)| all | u64::from(place.mask) << (row * ROW))
    }

    /// The numbers of a row of slots, or none.
    #[inline(always)]
    pub fn rows_of(&self, row: usize) -> &[Row] {
        self.group(row).rows
    }

    /// A slot, if it holds an object of the kind.
    #[inline(always)]
    pub fn slot(&self, slot: usize) -> Option<Slot<'_>> {
        let Group { mask, rows } = self.group(slot / ROW);
        (mask >> (slot % ROW) & 1 != 0).then_some(Slot { rows, slot })
    }

    /// What is in a row of slots.
    #[inline(always)]
    pub fn group(&self, row: usize) -> Group<'_> {
        match self.places.get(row) {
            Some(Place { mask, group }) if *mask != 0 => {
                let first = *group as usize * K::ROWS;
                Group { mask: *mask, rows: &self.rows[first..first + K::ROWS] }
            }
            _ => Group { mask: 0, rows: &[] },
        }
    }
}

fn write(rows: &mut [Row], numbers: &[f32], lane: usize) {
    debug_assert!(numbers.len() <= MAX_ROWS);
    for (row, number) in rows.iter_mut().zip(numbers) {
        row.0[lane] = *number;
    }
}
