//! Best-first branch and bound: cells are halved until the largest upper bound is near the largest value found.

use std::rc::Rc;

use super::ascent::{Summit, climb, search};
use super::expansion::{Expander, Expansion};
use super::polynomial::Scratch;
use super::queue::Queue;
use super::region::{Cell, Region};
use super::residual::{Residual, narrow};
use super::{Effort, LONG};
use crate::domain::Domain;

/// Residuals beyond which a joint maximum gets no larger budget.
const BUDGETS: usize = 8;

/// Residuals beyond which each is searched from fewer starts.
const SEARCHES: usize = 16;

/// Terms of a residual beyond which its cells are enclosed by expansions.
const EXPANDED: usize = 50;

/// What the remainder of an expansion may take of the gap that is near enough.
const REMAINDER: f64 = 0.15;

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
struct Waiting {
    residual: usize,
    sign: f64,
    split: usize,
    cell: Cell,
    expansion: Option<Rc<Expansion>>,
}

/// Bounds the largest |f| of all `residuals` over `domain` together. Where it stays below `floor`, half as much again
/// is near enough. Whatever stays below a value found of any residual is left alone, and all draw on one budget, which
/// grows with the first eight of them. Without residuals all is zero.
pub fn maximum(residuals: &[Residual], domain: &Domain, effort: &Effort, floor: f64) -> Proof {
    let subject = |residual| Subject::new(residual, domain);
    let mut front = Front {
        subjects: residuals.iter().map(subject).collect(),
        tolerance: effort.tolerance,
        floor,
        queue: Queue::new(),
        proof: Proof { found: Summit { height: -1.0, x: Vec::new() }, ..Proof::default() },
        spent: 0,
        scratch: Scratch::default(),
    };
    let starts = match residuals.len() {
        0..=SEARCHES => effort.starts,
        more => (effort.starts * SEARCHES / more).max(effort.starts.min(2)),
    };
    front.search(starts);
    for residual in 0..residuals.len() {
        for sign in [1.0, -1.0] {
            front.enter(residual, front.subjects[residual].region.root, sign, f64::INFINITY, None);
        }
    }
    let budget = effort.boxes * residuals.len().min(BUDGETS);
    let mut open = 0.0;
    while let Some((upper, top)) = front.queue.pop() {
        // Where a cell has become a point, only rounding stands between the two bounds.
        let done = upper <= front.near() || front.spent >= budget;
        if done || !divisible(&top.cell, top.split) {
            open = upper;
            break;
        }
        for cell in halves(&top.cell, top.split) {
            front.enter(top.residual, cell, top.sign, upper, top.expansion.clone());
        }
    }
    let mut proof = front.proof;
    proof.found.height = proof.found.height.max(0.0);
    proof.upper = proof.upper.max(open).max(proof.found.height);
    proof
}

/// One of the residuals.
struct Subject<'a> {
    residual: &'a Residual,
    region: Region<'a>,
    /// Where the residual is long enough.
    expander: Option<Expander<'a>>,
    /// What enclosing a box without an expansion costs, in boxes.
    cost: usize,
}

impl<'a> Subject<'a> {
    fn new(residual: &'a Residual, domain: &'a Domain) -> Self {
        let terms = residual.polynomial.terms().count();
        let region = Region::new(domain, &residual.polynomial.joints);
        let expander = (terms > EXPANDED).then(|| Expander::new(residual));
        let cost = if terms > LONG { 2 * terms.div_ceil(LONG) } else { 1 };
        Self { residual, region, expander, cost }
    }
}

/// What is known so far: `proof.upper` covers the cells that were left alone, the queue holds the others.
struct Front<'a> {
    subjects: Vec<Subject<'a>>,
    tolerance: f64,
    floor: f64,
    queue: Queue<Waiting>,
    proof: Proof,
    /// Boxes, as much as they cost.
    spent: usize,
    scratch: Scratch,
}

impl Front<'_> {
    /// Searches every residual from below.
    fn search(&mut self, starts: usize) {
        for residual in 0..self.subjects.len() {
            let Subject { residual: f, region, .. } = &self.subjects[residual];
            let summit = search(f, region, starts, &mut self.scratch);
            self.offer(residual, summit);
        }
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

    /// Encloses a cell whose parent stays below `parent`, by the expansion that was good for the parent or else by
    /// one of its own or else directly; it waits unless its bound is near enough.
    fn enter(
        &mut self,
        residual: usize,
        cell: Cell,
        sign: f64,
        parent: f64,
        mut expansion: Option<Rc<Expansion>>,
    ) {
        self.proof.boxes += 1;
        let room = REMAINDER * (self.near() - self.proof.found.height);
        let Subject { residual: f, region, expander, cost } = &mut self.subjects[residual];
        if let (Some(expander), None) = (expander.as_mut(), &expansion) {
            expansion = expander.expand(&region.frame(&cell), room).map(Rc::new);
        }
        let narrowed = if let (Some(expander), Some(expansion)) = (expander, &expansion) {
            self.spent += 1;
            narrow(region, cell, |frame| expander.enclose(expansion, frame, sign))
        } else {
            self.spent += *cost;
            narrow(region, cell, |frame| f.enclose(frame, &f.jet(frame, &mut self.scratch), sign))
        };
        let Some((cell, enclosure)) = narrowed else { return };
        if enclosure.least > self.proof.found.height {
            let centre: Vec<f64> = middle(&cell, region.variables());
            let summit = climb(f, region, &centre, &mut self.scratch);
            self.offer(residual, summit);
        }
        let upper = enclosure.upper.min(parent);
        if upper <= self.near() {
            self.proof.upper = self.proof.upper.max(upper);
        } else {
            self.queue.push(upper, Waiting { residual, sign, split: enclosure.split, cell, expansion });
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
