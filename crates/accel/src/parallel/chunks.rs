//! Items and tasks shared by threads, chunk by chunk. Each is a task of its own, since some take far longer than others:
//! of an image's rows, most may show nothing.
//!
//! It comes as a trait object: a call for each chunk costs nothing, and rayon's part is compiled once for a
//! type of items, not once for every structure, ray-triangle test and instruction set.

use super::prelude::*;
use super::threads;

/// Calls `work` with the number and the items of each chunk of `size` items, the last of which may be shorter.
///
/// # Panics
/// If `size` is 0.
pub fn for_each_chunk<T: Send>(items: &mut [T], size: usize, work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    if threads() == 1 {
        items.chunks_mut(size).enumerate().for_each(|(chunk, items)| work(chunk, items));
    } else {
        items.par_chunks_mut(size).with_max_len(1).enumerate().for_each(|(chunk, items)| work(chunk, items));
    }
}

/// What `work` returns for each chunk of `size` items, in order; see [`for_each_chunk`].
///
/// # Panics
/// If `size` is 0.
pub fn map_chunks<T: Send, R: Send>(
    items: &mut [T],
    size: usize,
    work: &(dyn Fn(usize, &mut [T]) -> R + Sync),
) -> Vec<R> {
    if threads() == 1 {
        items.chunks_mut(size).enumerate().map(|(chunk, items)| work(chunk, items)).collect()
    } else {
        items
            .par_chunks_mut(size)
            .with_max_len(1)
            .enumerate()
            .map(|(chunk, items)| work(chunk, items))
            .collect()
    }
}

/// What `work` returns for each of the numbers `0..tasks`, in order.
pub fn map_tasks<R: Send>(tasks: usize, work: &(dyn Fn(usize) -> R + Sync)) -> Vec<R> {
    if threads() == 1 {
        (0..tasks).map(work).collect()
    } else {
        (0..tasks).into_par_iter().with_max_len(1).map(work).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_met_once_and_results_are_in_order_whatever_the_number_of_threads() {
        for threads in [1, 3] {
            let pool = ::rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut items = vec![0; 10];
            let number = |chunk: usize, items: &mut [usize]| {
                for (i, item) in items.iter_mut().enumerate() {
                    *item += 4 * chunk + i;
                }
                items.len()
            };
            let lengths = pool.install(|| map_chunks(&mut items, 4, &number));
            assert_eq!(lengths, [4, 4, 2]);
            pool.install(|| {
                for_each_chunk(&mut items, 4, &|chunk, items| {
                    number(chunk, items);
                })
            });
            assert!(items.into_iter().eq((0..10).map(|i| 2 * i)));
            assert_eq!(pool.install(|| map_tasks(5, &|task| task * task)), [0, 1, 4, 9, 16]);
        }
    }
}
