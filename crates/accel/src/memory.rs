//! How much memory a structure may take, and taking it.

use crate::parallel::prelude::*;
use crate::parallel::repeat_n;

/// A vector of equal values, written by all threads of the current pool: its memory is new to the process as a rule, and the
/// system clears each page when it is first written to.
pub fn filled<T: Clone + Send>(value: T, len: usize) -> Vec<T> {
    const TASK: usize = 1 << 12;
    repeat_n(value, len).with_min_len(TASK).collect()
}

/// The elements of all vectors in order, moved by all threads of the current pool.
pub fn concatenated<T: Copy + Send + Sync>(parts: &[Vec<T>]) -> Vec<T> {
    let Some(first) = parts.iter().find_map(|part| part.first()) else { return Vec::new() };
    let len = parts.iter().map(Vec::len).sum();
    if crate::parallel::threads() == 1 || size_of::<T>() * len < WORTH_SHARING {
        return parts.concat();
    }
    let mut all = filled(*first, len);
    let mut rest = &mut all[..];
    let rooms: Vec<_> =
        parts.iter().map(|part| (part, rest.split_off_mut(..part.len()).expect("room for all"))).collect();
    rooms.into_par_iter().for_each(|(part, room)| room.copy_from_slice(part));
    all
}

/// Bytes from which on threads are asked to help moving them.
const WORTH_SHARING: usize = 1 << 20;

/// Taken where the system does not tell: 16 GiB.
const UNKNOWN: u128 = 16 << 30;

/// Bytes that can be allocated now without swapping: the default limit that builders hold
/// their needs against before they allocate (see [`crate::BuildError::TooLarge`]).
///
/// Read from `/proc/meminfo`; 16 GiB where there is none.
pub fn available_memory() -> u128 {
    std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| available(&text)).unwrap_or(UNKNOWN)
}

fn available(meminfo: &str) -> Option<u128> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u128 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_joined_in_order_whatever_the_number_of_threads() {
        for (part, parts) in [(0, 3), (5, 4), (70_000, 7)] {
            let parts: Vec<Vec<u32>> = (0..parts).map(|i| (i * part..(i + 1) * part).collect()).collect();
            let expected: Vec<u32> = parts.iter().flatten().copied().collect();
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert_eq!(pool.install(|| concatenated(&parts)), expected);
            }
        }
    }

    #[test]
    fn the_line_is_read_in_bytes() {
        let text = "MemTotal:       16316412 kB\nMemAvailable:    1024 kB\n";
        assert_eq!(available(text), Some(1 << 20));
        assert_eq!(available("MemTotal: 1 kB\n"), None);
        assert!(available_memory() > 0);
    }
}
