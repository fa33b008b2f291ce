//! Which references each cell holds: the two passes of Lagae and Dutré 2008, §3.2, on all
//! threads of the current pool.

use crate::settings::Settings;
use accel::parallel::prelude::*;
use accel::{BuildError, Cancel};
use lanes::ones;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

/// For each cell a list of references, one list behind another.
#[derive(Debug)]
pub(crate) struct Lists {
    /// Where each cell's list begins, and behind the last cell where it ends.
    pub offsets: Vec<u32>,
    /// All lists; ascending within a cell.
    pub references: Vec<u32>,
}

/// The memory a grid may take.
#[derive(Clone, Copy)]
pub(crate) struct Limit {
    pub structure: &'static str,
    pub bytes: u128,
}

impl Limit {
    pub fn of(structure: &'static str, settings: &Settings) -> Self {
        Self { structure, bytes: settings.memory.unwrap_or_else(accel::available_memory) }
    }

    /// The number of cells, if an array of them with `each` bytes fits.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if it doesn't, or has more cells than 32 bits number.
    pub fn cells(self, cells: u128, each: u128) -> Result<usize, BuildError> {
        let most = self.bytes.min(u128::from(u32::MAX) * each);
        Self { bytes: most, ..self }.check(cells * each)?;
        Ok(cells as usize)
    }

    /// What is left when so much is taken by something else.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if that is more than there is.
    pub fn less(self, taken: u128) -> Result<Self, BuildError> {
        self.check(taken)?;
        Ok(Self { bytes: self.bytes - taken, ..self })
    }

    /// So many values, none of them set.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory, [`BuildError::Cancelled`].
    pub fn blank<T: Default>(self, len: usize, cancel: Cancel) -> Result<Vec<T>, BuildError> {
        // The system clears each page at the first touch, which takes a second for a few gigabytes.
        const PIECE: usize = 1 << 22;
        let mut blank = accel::reserved(self.structure, len)?;
        while blank.len() < len {
            cancel.check(self.structure)?;
            blank.resize_with(len.min(blank.len() + PIECE), T::default);
        }
        Ok(blank)
    }

    pub fn check(self, bytes: u128) -> Result<(), BuildError> {
        let Self { structure, bytes: limit } = self;
        if bytes <= limit {
            return Ok(());
        }
        Err(BuildError::TooLarge { structure: structure.into(), bytes, limit })
    }
}

/// Up to 64 cells in a row: the first one's number, and a bit for each that is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Word {
    pub first: u32,
    pub bits: u64,
}

impl Word {
    fn cells(self) -> impl Iterator<Item = usize> {
        ones(self.bits).map(move |place| self.first as usize + place)
    }
}

/// Lists, for each of `cells` cells, those of the references `0..references` that
/// `cells_of` puts there. `cells_of` appends cells to an empty vector, each once.
/// `bytes(n)` is what a grid with n references in its lists takes, held against the limit before it is
/// allocated.
///
/// # Errors
/// [`BuildError::TooLarge`] if memory or 32-bit positions don't suffice, [`BuildError::Cancelled`].
pub(crate) fn register(
    cells: usize,
    references: u32,
    limit: Limit,
    cancel: Cancel,
    bytes: impl Fn(u64) -> u128,
    cells_of: impl Fn(u32, &mut Vec<Word>) -> Result<(), BuildError> + Sync,
) -> Result<Lists, BuildError> {
    limit.check(bytes(0))?;
    let alone = accel::parallel::threads() == 1;
    let add = |counter: &AtomicU32, n: u32| {
        if alone {
            // No lock prefix where nobody else looks.
            let old = counter.load(Relaxed);
            counter.store(old.wrapping_add(n), Relaxed);
            old
        } else {
            counter.fetch_add(n, Relaxed)
        }
    };
    // Each is few to a chunk, as one reference may be in every cell.
    const CHUNK: u32 = 64;
    // Beyond the counters, what has been counted is more than can be numbered.
    let counted = AtomicU64::new(0);
    let most = u64::from(u32::MAX);
    let each = |with: &(dyn Fn(u32, &[Word]) + Sync)| {
        let failed = OnceLock::new();
        (0..references.div_ceil(CHUNK)).into_par_iter().for_each_init(Vec::new, |found, chunk| {
            for reference in chunk * CHUNK..references.min((chunk + 1) * CHUNK) {
                if cancel.is_asked() || counted.load(Relaxed) > most || failed.get().is_some() {
                    return;
                }
                found.clear();
                match cells_of(reference, found) {
                    Ok(()) => with(reference, found),
                    // Where another thread failed first, its error is as good.
                    Err(error) => drop(failed.set(error)),
                }
            }
        });
        failed.into_inner().map_or_else(|| cancel.check(limit.structure), Err)
    };
    let offsets: Vec<AtomicU32> = limit.blank(cells + 1, cancel)?;
    each(&|_, found| {
        counted.fetch_add(found.iter().map(|word| u64::from(word.bits.count_ones())).sum(), Relaxed);
        for cell in found.iter().flat_map(|word| word.cells()) {
            add(&offsets[cell], 1);
        }
    })?;
    let end = counted.load(Relaxed);
    let numbered = bytes(most);
    Limit { bytes: limit.bytes.min(numbered), ..limit }.check(bytes(end))?;
    // Each cell's entry becomes the end of its list; filling moves it down to the start.
    let mut ends = 0;
    for offset in &offsets {
        ends += offset.load(Relaxed);
        offset.store(ends, Relaxed);
    }
    let lists: Vec<AtomicU32> = limit.blank(end as usize, cancel)?;
    each(&|reference, found| {
        for cell in found.iter().flat_map(|word| word.cells()) {
            let place = add(&offsets[cell], u32::MAX) - 1;
            lists[place as usize].store(reference, Relaxed);
        }
    })?;
    // These keep their memory.
    let offsets: Vec<u32> = offsets.into_iter().map(AtomicU32::into_inner).collect();
    let mut references: Vec<u32> = lists.into_iter().map(AtomicU32::into_inner).collect();
    sort_lists(&offsets, &mut references, (limit, cancel))?;
    cancel.check(limit.structure)?;
    Ok(Lists { offsets, references })
}

/// Puts every list in ascending order, so that threads leave no trace.
fn sort_lists(
    offsets: &[u32],
    mut references: &mut [u32],
    (limit, cancel): (Limit, Cancel),
) -> Result<(), BuildError> {
    const CHUNK: usize = 1 << 14;
    let cells = offsets.len() - 1;
    let mut chunks = accel::reserved(limit.structure, cells.div_ceil(CHUNK))?;
    for first in (0..cells).step_by(CHUNK) {
        let last = cells.min(first + CHUNK);
        let (own, rest) = references.split_at_mut((offsets[last] - offsets[first]) as usize);
        chunks.push((&offsets[first..=last], own));
        references = rest;
    }
    chunks.into_par_iter().for_each(|(offsets, references)| {
        if cancel.is_asked() {
            return;
        }
        for ends in offsets.windows(2) {
            if ends[1] - ends[0] > 1 {
                references[(ends[0] - offsets[0]) as usize..(ends[1] - offsets[0]) as usize].sort_unstable();
            }
        }
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANY: Limit = Limit { structure: "test", bytes: u128::MAX };

    fn words(cells: impl Iterator<Item = u32>) -> Word {
        Word { first: 0, bits: cells.fold(0, |bits, cell| bits | 1 << cell) }
    }

    fn modulo(threads: usize) -> Lists {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let cells_of = |r: u32, found: &mut Vec<Word>| {
            found.push(words((0..7).filter(|cell| r.is_multiple_of(cell + 2))));
            Ok(())
        };
        let bytes = |n| 4 * u128::from(n);
        pool.install(|| register(8, 1000, ANY, Cancel::NEVER, bytes, cells_of)).unwrap()
    }

    #[test]
    fn lists_are_whole_and_in_order_on_any_number_of_threads() {
        for lists in [modulo(1), modulo(3)] {
            assert_eq!(lists.offsets.len(), 9);
            assert_eq!(lists.offsets[7], lists.offsets[8], "the last cell is empty");
            for cell in 0..7u32 {
                let list = &lists.references
                    [lists.offsets[cell as usize] as usize..lists.offsets[cell as usize + 1] as usize];
                let expected: Vec<u32> = (0..1000).filter(|r| r % (cell + 2) == 0).collect();
                assert_eq!(list, expected);
            }
        }
    }

    #[test]
    fn the_limit_is_held_before_and_after_counting() {
        let all = |_: u32, found: &mut Vec<Word>| {
            found.extend([Word { first: 0, bits: u64::MAX }, Word { first: 64, bits: (1 << 36) - 1 }]);
            Ok(())
        };
        let bytes = |n: u64| 400 + 4 * u128::from(n);
        let with =
            |limit| register(100, 50, Limit { structure: "test", bytes: limit }, Cancel::NEVER, bytes, all);
        let error = |bytes, limit| BuildError::TooLarge { structure: "test".into(), bytes, limit };
        assert_eq!(with(100).unwrap_err(), error(400, 100));
        assert_eq!(with(500).unwrap_err(), error(20_400, 500));
        assert!(with(20_400).is_ok());
    }

    #[test]
    fn a_failure_of_one_reference_is_the_failure_of_all() {
        let error = || BuildError::TooLarge { structure: "test".into(), bytes: 2, limit: 1 };
        let seen = AtomicU32::new(0);
        let cells_of = |reference: u32, _: &mut Vec<Word>| {
            seen.fetch_add(1, Relaxed);
            if reference == 500 { Err(error()) } else { Ok(()) }
        };
        assert_eq!(register(8, 1000, ANY, Cancel::NEVER, |_| 0, cells_of).unwrap_err(), error());
        assert!(seen.into_inner() <= 1000, "there is no second pass");
    }

    #[test]
    fn a_cancelled_registration_ends_between_references() {
        let seen = AtomicU32::new(0);
        let enough = || seen.load(Relaxed) >= 5;
        let count = |_: u32, _: &mut Vec<Word>| {
            seen.fetch_add(1, Relaxed);
            Ok(())
        };
        let ended = register(8, 1000, ANY, Cancel::when(&enough), |_| 0, count).unwrap_err();
        assert_eq!(ended, BuildError::Cancelled { structure: "test".into() });
        assert!(seen.into_inner() < 100);
    }
}
