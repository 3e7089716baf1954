//! Best-first branch and bound: cells are halved until the largest upper bound is near the largest value found.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Effort;
use super::ascent::{Summit, climb, search};
use super::polynomial::Scratch;
use super::region::{Cell, Region};
use super::residual::Residual;

/// What branch and bound proves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Proof {
    /// |f| exceeds this nowhere.
    pub upper: f64,
    /// The largest |f| that was found.
    pub found: Summit,
    /// Cells enclosed.
    pub boxes: usize,
}

/// A cell waiting to be halved, for the maximum of `sign`·f.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    pub upper: f64,
    /// Order of arrival, which settles ties.
    pub number: usize,
    pub sign: f64,
    pub split: usize,
    pub cell: Cell,
}

/// Bounds max |f| over `region`. Where the largest value stays below `floor`, half as much again is near enough.
pub fn maximum(residual: &Residual, region: &Region, effort: &Effort, floor: f64) -> Proof {
    let mut scratch = Scratch::default();
    let mut found = search(residual, region, effort.starts, &mut scratch);
    let near = |found: f64| {
        let fine = found * (1.0 + effort.tolerance);
        if found <= floor { fine.max(1.5 * found.max(f64::MIN_POSITIVE)) } else { fine }
    };
    let budget = effort.budget(residual.polynomial.terms().count());
    let mut heap = BinaryHeap::new();
    let (mut boxes, mut settled) = (0, found.height);
    let mut enter =
        |heap: &mut BinaryHeap<Waiting>, found: &mut Summit, cell: Cell, sign: f64, parent: f64| {
            boxes += 1;
            let narrowed = residual.narrow(region, cell, sign, &mut scratch);
            let Some((cell, enclosure)) = narrowed else { return boxes };
            if sign * enclosure.centre > found.height {
                let centre: Vec<f64> = middle(&cell, region.variables());
                *found = std::mem::take(found).or(climb(residual, region, &centre, &mut scratch));
            }
            let upper = enclosure.upper.min(parent);
            if upper <= near(found.height) {
                settled = settled.max(upper);
            } else {
                heap.push(Waiting { upper, number: boxes, sign, split: enclosure.split, cell });
            }
            boxes
        };
    let mut count = 0;
    for sign in [1.0, -1.0] {
        count = enter(&mut heap, &mut found, region.root, sign, f64::INFINITY);
    }
    let mut open = 0.0;
    while let Some(top) = heap.pop() {
        // Where a cell has become a point, only rounding stands between the two bounds.
        if top.upper <= near(found.height) || count >= budget || !divisible(&top.cell, top.split) {
            open = top.upper;
            break;
        }
        for cell in halves(&top.cell, top.split) {
            count = enter(&mut heap, &mut found, cell, top.sign, top.upper);
        }
    }
    Proof { upper: settled.max(open).max(found.height), found, boxes: count }
}

/// The centre of a cell.
pub(super) fn middle(cell: &Cell, variables: usize) -> Vec<f64> {
    (0..variables).map(|i| 0.5 * (cell.low[i] + cell.high[i])).collect()
}

/// Whether the side `i` still has a number between its ends.
pub(super) fn divisible(cell: &Cell, i: usize) -> bool {
    let middle = 0.5 * (cell.low[i] + cell.high[i]);
    cell.low[i] < middle && middle < cell.high[i]
}

/// The two halves of a cell along `i`.
pub(super) fn halves(cell: &Cell, i: usize) -> [Cell; 2] {
    let middle = 0.5 * (cell.low[i] + cell.high[i]);
    let (mut low, mut high) = (*cell, *cell);
    low.high[i] = middle;
    high.low[i] = middle;
    [low, high]
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper).then_with(|| other.number.cmp(&self.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}
