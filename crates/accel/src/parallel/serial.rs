//! The calling thread alone. Named and behaving as in rayon, as far as the workspace uses it.

/// How many threads the work is shared by: the calling one alone.
pub fn threads() -> usize {
    1
}

/// Does one after the other.
pub fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
    (first(), second())
}

/// See [`Vec::extend`].
pub fn extend<T>(all: &mut Vec<T>, items: impl IntoIterator<Item = T>) {
    all.extend(items);
}

/// See [`std::iter::repeat_n`].
pub fn repeat_n<T: Clone>(value: T, len: usize) -> Serial<std::iter::RepeatN<T>> {
    Serial(std::iter::repeat_n(value, len))
}

/// What gives collections their `par_` methods.
pub mod prelude {
    pub use super::{IntoSerial as _, SerialSlice as _};
}

/// An iterator with the methods of a parallel one.
#[derive(Clone, Debug)]
pub struct Serial<I>(I);

impl<I: Iterator> IntoIterator for Serial<I> {
    type Item = I::Item;
    type IntoIter = I;
    fn into_iter(self) -> I {
        self.0
    }
}

impl<I: Iterator> Serial<I> {
    /// Does nothing: there are no tasks to keep large.
    #[must_use]
    pub fn with_min_len(self, _: usize) -> Self {
        self
    }

    /// Does nothing: there are no tasks to keep small.
    #[must_use]
    pub fn with_max_len(self, _: usize) -> Self {
        self
    }

    /// See [`Iterator::enumerate`].
    pub fn enumerate(self) -> Serial<impl Iterator<Item = (usize, I::Item)>> {
        Serial(self.0.enumerate())
    }

    /// See [`Iterator::zip`].
    pub fn zip<J: IntoIterator>(self, other: J) -> Serial<impl Iterator<Item = (I::Item, J::Item)>> {
        Serial(self.0.zip(other))
    }

    /// See [`Iterator::step_by`].
    pub fn step_by(self, step: usize) -> Serial<impl Iterator<Item = I::Item>> {
        Serial(self.0.step_by(step))
    }

    /// See [`Iterator::map`].
    pub fn map<T>(self, of: impl FnMut(I::Item) -> T) -> Serial<impl Iterator<Item = T>> {
        Serial(self.0.map(of))
    }

    /// See [`Iterator::map`]; `of` is handed what `init` makes.
    pub fn map_init<S, T>(
        self,
        init: impl FnOnce() -> S,
        mut of: impl FnMut(&mut S, I::Item) -> T,
    ) -> Serial<impl Iterator<Item = T>> {
        let mut state = init();
        Serial(self.0.map(move |item| of(&mut state, item)))
    }

    /// See [`Iterator::filter`].
    pub fn filter(self, wanted: impl FnMut(&I::Item) -> bool) -> Serial<impl Iterator<Item = I::Item>> {
        Serial(self.0.filter(wanted))
    }

    /// See [`Iterator::filter_map`].
    pub fn filter_map<T>(self, of: impl FnMut(I::Item) -> Option<T>) -> Serial<impl Iterator<Item = T>> {
        Serial(self.0.filter_map(of))
    }

    /// See [`Iterator::for_each`].
    pub fn for_each(self, with: impl FnMut(I::Item)) {
        self.0.for_each(with);
    }

    /// See [`Iterator::for_each`]; `with` is handed what `init` makes.
    pub fn for_each_init<S>(self, init: impl FnOnce() -> S, mut with: impl FnMut(&mut S, I::Item)) {
        let mut state = init();
        self.0.for_each(|item| with(&mut state, item));
    }

    /// See [`Iterator::any`].
    pub fn any(mut self, is: impl FnMut(I::Item) -> bool) -> bool {
        self.0.any(is)
    }

    /// See [`Iterator::all`].
    pub fn all(mut self, are: impl FnMut(I::Item) -> bool) -> bool {
        self.0.all(are)
    }

    /// See [`Iterator::fold`].
    pub fn reduce(
        self,
        start: impl FnOnce() -> I::Item,
        with: impl FnMut(I::Item, I::Item) -> I::Item,
    ) -> I::Item {
        self.0.fold(start(), with)
    }

    /// See [`Iterator::sum`].
    pub fn sum<T: std::iter::Sum<I::Item>>(self) -> T {
        self.0.sum()
    }

    /// The first of all that `find` finds, as any would do.
    pub fn find_any(mut self, find: impl FnMut(&I::Item) -> bool) -> Option<I::Item> {
        self.0.find(find)
    }

    /// See [`Iterator::find_map`].
    pub fn find_map_first<T>(mut self, find: impl FnMut(I::Item) -> Option<T>) -> Option<T> {
        self.0.find_map(find)
    }

    /// See [`Iterator::collect`].
    pub fn collect<C: FromIterator<I::Item>>(self) -> C {
        self.0.collect()
    }
}

/// Collections by value.
pub trait IntoSerial: IntoIterator + Sized {
    /// Iterates.
    fn into_par_iter(self) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }
}

impl<C: IntoIterator> IntoSerial for C {}

/// Slices.
pub trait SerialSlice<T> {
    /// See [`slice::iter`].
    fn par_iter(&self) -> Serial<std::slice::Iter<'_, T>>;
    /// See [`slice::iter_mut`].
    fn par_iter_mut(&mut self) -> Serial<std::slice::IterMut<'_, T>>;
    /// See [`slice::windows`].
    fn par_windows(&self, size: usize) -> Serial<std::slice::Windows<'_, T>>;
    /// See [`slice::chunks`].
    fn par_chunks(&self, size: usize) -> Serial<std::slice::Chunks<'_, T>>;
    /// See [`slice::chunks_mut`].
    fn par_chunks_mut(&mut self, size: usize) -> Serial<std::slice::ChunksMut<'_, T>>;
    /// See [`slice::chunks_exact_mut`].
    fn par_chunks_exact_mut(&mut self, size: usize) -> Serial<std::slice::ChunksExactMut<'_, T>>;
    /// See [`slice::sort_unstable`].
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
}

impl<T> SerialSlice<T> for [T] {
    fn par_iter(&self) -> Serial<std::slice::Iter<'_, T>> {
        Serial(self.iter())
    }

    fn par_iter_mut(&mut self) -> Serial<std::slice::IterMut<'_, T>> {
        Serial(self.iter_mut())
    }

    fn par_windows(&self, size: usize) -> Serial<std::slice::Windows<'_, T>> {
        Serial(self.windows(size))
    }

    fn par_chunks(&self, size: usize) -> Serial<std::slice::Chunks<'_, T>> {
        Serial(self.chunks(size))
    }

    fn par_chunks_mut(&mut self, size: usize) -> Serial<std::slice::ChunksMut<'_, T>> {
        Serial(self.chunks_mut(size))
    }

    fn par_chunks_exact_mut(&mut self, size: usize) -> Serial<std::slice::ChunksExactMut<'_, T>> {
        Serial(self.chunks_exact_mut(size))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::prelude::*;

    #[test]
    fn the_methods_do_what_their_names_say() {
        let numbers: Vec<u32> = (0..10u32).into_par_iter().with_min_len(3).filter(|n| n % 2 == 0).collect();
        assert_eq!(numbers, [0, 2, 4, 6, 8]);
        let most = numbers.par_iter().map(|n| n + 1).reduce(|| 0, u32::max);
        assert_eq!(most, 9);
        let mut sums = [0; 3];
        sums.par_chunks_mut(1).zip(numbers.par_chunks(2)).for_each(|(sum, pair)| sum[0] = pair.iter().sum());
        assert_eq!(sums, [2, 10, 8]);
        sums.par_sort_unstable();
        assert_eq!((sums, super::join(|| 1, || 2)), ([2, 8, 10], (1, 2)));
    }
}
