//! What waits to be divided, the largest upper bound first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A queue in which ties go by the order of arrival, so that no result depends on the heap.
pub(super) struct Queue<T> {
    heap: BinaryHeap<Ranked<T>>,
    arrivals: usize,
}

struct Ranked<T> {
    upper: f64,
    number: usize,
    item: T,
}

impl<T> Queue<T> {
    pub fn new() -> Self {
        Self { heap: BinaryHeap::new(), arrivals: 0 }
    }

    pub fn push(&mut self, upper: f64, item: T) {
        self.arrivals += 1;
        self.heap.push(Ranked { upper, number: self.arrivals, item });
    }

    /// What has the largest upper bound, after that bound.
    pub fn pop(&mut self) -> Option<(f64, T)> {
        self.heap.pop().map(|ranked| (ranked.upper, ranked.item))
    }
}

impl<T> Ord for Ranked<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper).then_with(|| other.number.cmp(&self.number))
    }
}

impl<T> PartialOrd for Ranked<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for Ranked<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for Ranked<T> {}
