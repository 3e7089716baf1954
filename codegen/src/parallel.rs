//! Work on many items by several threads at once, results in the order of the items.
//!
//! The methods are named as those of `rayon`, whose threads do the work. Behind every one of them stands the same
//! compiled loop over parts of the items, where each call of `rayon` would be compiled for itself: that took a sixth of
//! the time in which this crate builds.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// Parts of the items for each thread: items may differ in what they take.
const PARTS: usize = 64;

/// Items that are worked on by several threads at once. Every method returns when all work is done.
#[derive(Debug)]
pub struct Parallel<T>(Vec<T>);

/// Everything that has items can have them worked on by several threads.
pub trait Parallelize {
    /// The items.
    fn into_par_iter(self) -> Parallel<Self::Item>
    where
        Self: IntoIterator + Sized,
    {
        Parallel(self.into_iter().collect())
    }

    /// References to the items.
    fn par_iter<'a>(&'a self) -> Parallel<<&'a Self as IntoIterator>::Item>
    where
        &'a Self: IntoIterator,
    {
        Parallel(self.into_iter().collect())
    }

    /// Mutable references to the items.
    fn par_iter_mut<'a>(&'a mut self) -> Parallel<<&'a mut Self as IntoIterator>::Item>
    where
        &'a mut Self: IntoIterator,
    {
        Parallel(self.into_iter().collect())
    }
}

impl<T: ?Sized> Parallelize for T {}

impl<T: Send> Parallel<T> {
    /// What `f` makes of each item.
    pub fn map<R: Send>(self, f: impl Fn(T) -> R + Sync) -> Parallel<R> {
        let threads = rayon::current_num_threads();
        let size = self.0.len().div_ceil(PARTS * threads).max(1);
        let parts: Vec<Part<T, R>> = split(self.0, size);
        each(parts.len(), &|index| parts[index].work(&f));
        Parallel(parts.into_iter().flat_map(Part::done).collect())
    }

    /// What `f` makes of each item, where it makes something of it.
    pub fn filter_map<R: Send>(self, f: impl Fn(T) -> Option<R> + Sync) -> Parallel<R> {
        Parallel(self.map(f).0.into_iter().flatten().collect())
    }

    /// All that `f` makes of each item.
    pub fn flat_map_iter<I: IntoIterator<Item: Send>>(self, f: impl Fn(T) -> I + Sync) -> Parallel<I::Item> {
        let lists = self.map(|item| f(item).into_iter().collect::<Vec<_>>());
        Parallel(lists.0.into_iter().flatten().collect())
    }

    /// Does `f` with each item.
    pub fn for_each(self, f: impl Fn(T) + Sync) {
        self.map(f);
    }

    /// The first item for which `f` holds; of those behind it some are not looked at.
    pub fn find_first(self, f: impl Fn(&T) -> bool + Sync) -> Option<T> {
        let first = AtomicUsize::new(usize::MAX);
        let found = self.enumerate().map(|(index, item)| {
            // A late view of the others costs work and nothing else.
            let holds = index < first.load(Ordering::Relaxed) && f(&item);
            if holds {
                first.fetch_min(index, Ordering::Relaxed);
            }
            holds.then_some(item)
        });
        found.0.into_iter().flatten().next()
    }
}

impl<T> Parallel<T> {
    /// The items with their numbers from 0.
    pub fn enumerate(self) -> Parallel<(usize, T)> {
        Parallel(self.0.into_iter().enumerate().collect())
    }

    /// The items with those of `other`.
    pub fn zip<U>(self, other: impl IntoIterator<Item = U>) -> Parallel<(T, U)> {
        Parallel(self.0.into_iter().zip(other).collect())
    }

    /// The items and, after them, those of `other`.
    pub fn chain(mut self, other: Parallel<T>) -> Self {
        self.0.extend(other.0);
        self
    }

    /// The items for which `f`, which should be quick, holds.
    pub fn filter(mut self, f: impl Fn(&T) -> bool) -> Self {
        self.0.retain(f);
        self
    }

    /// The items as a collection.
    pub fn collect<C: FromIterator<T>>(self) -> C {
        self.0.into_iter().collect()
    }
}

/// A run of items, and what was made of them.
struct Part<T, R>(Mutex<(Vec<T>, Vec<R>)>);

impl<T, R> Part<T, R> {
    fn work(&self, f: &impl Fn(T) -> R) {
        // Nobody else has this part, and after a panic nobody reads it.
        let mut part = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let items = std::mem::take(&mut part.0);
        part.1 = items.into_iter().map(f).collect();
    }

    fn done(self) -> Vec<R> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).1
    }
}

fn split<T, R>(items: Vec<T>, size: usize) -> Vec<Part<T, R>> {
    let mut parts = Vec::with_capacity(items.len().div_ceil(size));
    let mut items = items.into_iter();
    loop {
        let part: Vec<T> = items.by_ref().take(size).collect();
        if part.is_empty() {
            return parts;
        }
        parts.push(Part(Mutex::new((part, Vec::new()))));
    }
}

/// Calls `task` with every index below `count`, by all threads; compiled once.
fn each(count: usize, task: &(dyn Fn(usize) + Sync)) {
    IntoParallelIterator::into_par_iter(0..count).for_each(task);
}

#[cfg(test)]
mod tests {
    use super::Parallelize;

    #[test]
    fn results_stand_in_the_order_of_the_items() {
        for count in [0, 1, 2, 127, 128, 129, 1000, 100_000] {
            let squares: Vec<usize> = (0..count).into_par_iter().map(|x| x * x).collect();
            assert_eq!(squares, (0..count).map(|x| x * x).collect::<Vec<_>>());
            let odd: Vec<usize> = squares.par_iter().filter_map(|x| (x % 2 == 1).then_some(*x)).collect();
            assert_eq!(odd, (0..count).map(|x| x * x).filter(|x| x % 2 == 1).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_that_holds_is_found() {
        for first in [0, 1, 77, 999] {
            assert_eq!((0..1000).into_par_iter().find_first(|&x| x >= first), Some(first));
        }
        assert_eq!((0..1000).into_par_iter().find_first(|&x| x > 999), None);
    }

    #[test]
    fn what_is_inside_another_ends() {
        let sums: Vec<usize> = (0..200_usize)
            .into_par_iter()
            .map(|x| (0..x).into_par_iter().map(|y| y).collect::<Vec<_>>().into_iter().sum())
            .collect();
        assert!(sums.iter().enumerate().all(|(x, sum)| 2 * sum == x * x.saturating_sub(1)));
    }

    #[test]
    fn items_are_changed_where_they_stand() {
        let mut rows = vec![vec![1, 2], vec![3]];
        rows.par_iter_mut().zip(&[10, 20]).for_each(|(row, more)| row.iter_mut().for_each(|x| *x += more));
        assert_eq!(rows, [vec![11, 12], vec![23]]);
    }
}
