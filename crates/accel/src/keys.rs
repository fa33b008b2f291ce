//! Sorting by keys with numbers.

use crate::BuildError;
use crate::parallel::extend;
use crate::parallel::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

const DIGIT: u32 = 11;
const DIGITS: usize = 3;
const VALUES: usize = 1 << DIGIT;

type Counts = [[u32; VALUES]; DIGITS];

/// From this many keys on the sort uses the threads of the current pool.
const PARALLEL: usize = 1 << 15;

/// Bytes that [`sort`] takes at most for so many keys and threads, besides the keys.
pub const fn sort_bytes(keys: usize, threads: usize) -> usize {
    let counts = if threads > DIGITS { threads + 1 } else { DIGITS };
    size_of::<u64>() * keys + counts * size_of::<[u32; VALUES]>()
}

/// Sorts by the upper 32 bits, equal ones staying in order: a radix sort, least digit first.
///
/// # Errors
/// Those of [`crate::reserved`].
pub fn sort(structure: &str, mut keys: Vec<u64>) -> Result<Vec<u64>, BuildError> {
    if keys.len() < VALUES / 4 {
        keys.sort_by_key(|key| key >> 32);
        return Ok(keys);
    }
    if keys.len() < PARALLEL || crate::parallel::threads() == 1 {
        let room = crate::zeroed(structure, keys.len())?;
        return Ok(on_one_thread(keys, room));
    }
    let mut room = crate::reserved(structure, keys.len())?;
    extend(&mut room, (0..keys.len()).into_par_iter().with_min_len(VALUES).map(|_| AtomicU64::new(0)));
    Ok(on_all_threads(keys, room))
}

#[inline(always)]
fn digit(key: u64, of: usize) -> usize {
    (key >> (32 + DIGIT * of as u32)) as usize & (VALUES - 1)
}

fn on_one_thread(mut keys: Vec<u64>, mut sorted: Vec<u64>) -> Vec<u64> {
    let mut counts = count(&keys);
    for (of, next) in counts.iter_mut().enumerate() {
        if all_alike(next, keys.len()) {
            continue;
        }
        let mut first = 0;
        for next in next.iter_mut() {
            first += std::mem::replace(next, first);
        }
        for key in &keys {
            let next = &mut next[digit(*key, of)];
            sorted[*next as usize] = *key;
            *next += 1;
        }
        std::mem::swap(&mut keys, &mut sorted);
    }
    keys
}

fn count(keys: &[u64]) -> Box<Counts> {
    let mut counts = Box::new([[0; VALUES]; DIGITS]);
    for key in keys {
        for (of, counts) in counts.iter_mut().enumerate() {
            counts[digit(*key, of)] += 1;
        }
    }
    counts
}

fn all_alike(counts: &[u32; VALUES], keys: usize) -> bool {
    counts.iter().any(|count| *count as usize == keys)
}

/// Each thread counts and moves a part of the keys; atomics let them write to one place after
/// another of the same buffer.
fn on_all_threads(keys: Vec<u64>, mut sorted: Vec<AtomicU64>) -> Vec<u64> {
    let part = keys.len().div_ceil(crate::parallel::threads());
    let mut keys: Vec<AtomicU64> = keys.into_iter().map(AtomicU64::new).collect();
    for of in 0..DIGITS {
        let counted = |keys: &[AtomicU64]| {
            let mut counts = [0u32; VALUES];
            for key in keys {
                counts[digit(key.load(Relaxed), of)] += 1;
            }
            counts
        };
        let mut next: Vec<[u32; VALUES]> = keys.par_chunks(part).map(counted).collect();
        let mut first = 0;
        for value in 0..VALUES {
            for next in &mut next {
                first += std::mem::replace(&mut next[value], first);
            }
        }
        keys.par_chunks(part).zip(&mut next).for_each(|(keys, next)| {
            for key in keys {
                let key = key.load(Relaxed);
                let next = &mut next[digit(key, of)];
                sorted[*next as usize].store(key, Relaxed);
                *next += 1;
            }
        });
        std::mem::swap(&mut keys, &mut sorted);
    }
    keys.into_iter().map(AtomicU64::into_inner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::morton::keyed;

    fn keys(len: u32, bits: u32) -> Vec<u64> {
        let mut seed = 1u64;
        (0..len)
            .map(|number| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                keyed((seed >> 32) as u32 >> (32 - bits), number)
            })
            .collect()
    }

    #[test]
    fn the_sort_is_stable_at_any_length_on_any_number_of_threads() {
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for (len, bits) in [(0, 8), (1, 8), (300, 32), (5000, 30), (5000, 3), (70_000, 32), (70_000, 9)] {
                let keys = keys(len, bits);
                let mut expected = keys.clone();
                expected.sort_unstable();
                assert_eq!(pool.install(|| sort("x", keys)), Ok(expected), "{len} keys of {bits} bits");
            }
        }
    }
}
