//! Best-first branch and bound: cells are halved until the largest upper bound is near the largest value found.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Effort;
use super::ascent::{Summit, climb, search};
use super::polynomial::Scratch;
use super::region::{Cell, Region};
use super::residual::Residual;
use crate::measure::Domain;
use crate::motion::Motion;

/// Residuals beyond which a joint maximum gets no larger budget.
const BUDGETS: usize = 8;

/// Residuals beyond which each is searched from fewer starts.
const SEARCHES: usize = 16;

/// What branch and bound proves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Proof {
    /// |f| of no residual exceeds this anywhere.
    pub upper: f64,
    /// The largest |f| that was found.
    pub found: Summit,
    /// The residual that attains it.
    pub residual: usize,
    /// Cells enclosed.
    pub boxes: usize,
}

/// A cell waiting to be halved, for the maximum of `sign`·f of one residual.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    pub upper: f64,
    /// Order of arrival, which settles ties.
    pub number: usize,
    pub residual: usize,
    pub sign: f64,
    pub split: usize,
    pub cell: Cell,
}

/// Bounds the largest |f| of all `residuals` over `domain` together. Where it stays below `floor`, half as much again
/// is near enough. Whatever stays below a value found of any residual is left alone, and all draw on one budget, that
/// of the longest residual for each of the first eight. Without residuals all is zero.
pub fn maximum(
    residuals: &[Residual],
    domain: &Domain,
    motion: Option<&Motion>,
    effort: &Effort,
    floor: f64,
) -> Proof {
    let regions: Vec<Region> =
        residuals.iter().map(|residual| Region::new(domain, motion, &residual.polynomial.joints)).collect();
    let longest = residuals.iter().map(|residual| residual.polynomial.terms().count()).max().unwrap_or(0);
    let budget = effort.budget(longest) * residuals.len().min(BUDGETS);
    let mut front = Front::new(residuals, &regions, effort, floor);
    for residual in 0..residuals.len() {
        for sign in [1.0, -1.0] {
            front.enter(residual, regions[residual].root, sign, f64::INFINITY);
        }
    }
    let mut open = 0.0;
    while let Some(top) = front.heap.pop() {
        // Where a cell has become a point, only rounding stands between the two bounds.
        let done = top.upper <= front.near() || front.proof.boxes >= budget;
        if done || !divisible(&top.cell, top.split) {
            open = top.upper;
            break;
        }
        for cell in halves(&top.cell, top.split) {
            front.enter(top.residual, cell, top.sign, top.upper);
        }
    }
    let mut proof = front.proof;
    proof.found.height = proof.found.height.max(0.0);
    proof.upper = proof.upper.max(open).max(proof.found.height);
    proof
}

/// What is known so far: `proof.upper` covers the cells that were left alone, the heap holds the others.
struct Front<'a> {
    residuals: &'a [Residual],
    regions: &'a [Region<'a>],
    tolerance: f64,
    floor: f64,
    heap: BinaryHeap<Waiting>,
    proof: Proof,
    scratch: Scratch,
}

impl<'a> Front<'a> {
    /// Searches every residual from below.
    fn new(residuals: &'a [Residual], regions: &'a [Region<'a>], effort: &Effort, floor: f64) -> Self {
        let starts = match residuals.len() {
            0..=SEARCHES => effort.starts,
            more => (effort.starts * SEARCHES / more).max(effort.starts.min(2)),
        };
        let mut out = Self {
            residuals,
            regions,
            tolerance: effort.tolerance,
            floor,
            heap: BinaryHeap::new(),
            proof: Proof { found: Summit { height: -1.0, x: Vec::new() }, ..Proof::default() },
            scratch: Scratch::default(),
        };
        for residual in 0..residuals.len() {
            let summit = search(&residuals[residual], &regions[residual], starts, &mut out.scratch);
            out.offer(residual, summit);
        }
        out
    }

    /// Keeps the higher of two summits, the earlier one where they tie.
    fn offer(&mut self, residual: usize, summit: Summit) {
        if summit.height > self.proof.found.height {
            (self.proof.found, self.proof.residual) = (summit, residual);
        }
    }

    /// The upper bound that is near enough.
    fn near(&self) -> f64 {
        let found = self.proof.found.height;
        let fine = found * (1.0 + self.tolerance);
        if found <= self.floor { fine.max(1.5 * found.max(f64::MIN_POSITIVE)) } else { fine }
    }

    /// Encloses a cell whose parent stays below `parent`; it waits unless its bound is near enough.
    fn enter(&mut self, residual: usize, cell: Cell, sign: f64, parent: f64) {
        self.proof.boxes += 1;
        let (f, region) = (&self.residuals[residual], &self.regions[residual]);
        let narrowed = f.narrow(region, cell, sign, &mut self.scratch);
        let Some((cell, enclosure)) = narrowed else { return };
        if sign * enclosure.centre > self.proof.found.height {
            let centre: Vec<f64> = middle(&cell, region.variables());
            let summit = climb(f, region, &centre, &mut self.scratch);
            self.offer(residual, summit);
        }
        let upper = enclosure.upper.min(parent);
        if upper <= self.near() {
            self.proof.upper = self.proof.upper.max(upper);
        } else {
            let number = self.proof.boxes;
            self.heap.push(Waiting { upper, number, residual, sign, split: enclosure.split, cell });
        }
    }
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
