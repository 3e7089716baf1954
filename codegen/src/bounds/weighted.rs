//! Largest weighted sum of absolute residuals.
//!
//! In a cell where a residual keeps its sign σ its absolute value is the smooth σr. The jets of all such residuals
//! are summed before they are enclosed: around the largest value their gradients cancel, where the enclosures of the
//! single residuals would add up. Where uncertain parameters give |r_m| as the largest of several, the vertices of
//! their box, the largest of their enclosures stands for it.

use std::collections::BTreeMap;

use super::branch::{divisible, halves};
use super::polynomial::{Jet, Polynomial, Scratch};
use super::queue::Queue;
use super::region::{Cell, Frame, MAX_VARIABLES, Region};
use super::residual::Residual;
use super::sum::{Part, Range, Stop};
use crate::domain::Domain;
use crate::lagrangian::{Function, MAX_JOINTS};

/// A sign that may change costs twice what lies beyond it; above this fraction of the residual's own bound that
/// bound serves better.
const UNSURE: f64 = 0.5;

/// Σ_m |r_m| Ū_m, and a residual whose derivatives' bounds hold for every choice of signs.
pub(super) struct Weighted<'a> {
    parts: Vec<Part<'a>>,
    whole: Residual,
    /// Σ cap Ū.
    ceiling: f64,
}

impl<'a> Weighted<'a> {
    /// `terms` are the residuals of `parts` in order, as functions with parameters; none for parts of several vertices.
    pub fn new(
        parts: Vec<Part<'a>>,
        terms: &[Vec<(&Function, f64)>],
        domain: &Domain,
        position_bound: &[f64],
    ) -> Self {
        let mut sizes: BTreeMap<Function, f64> = BTreeMap::new();
        for (part, terms) in parts.iter().zip(terms) {
            let mut own: BTreeMap<Function, [f64; 2]> = BTreeMap::new();
            for &(psi, k) in terms {
                let even = Function { sine: false, ..*psi };
                own.entry(even).or_default()[usize::from(psi.sine)] += k;
            }
            for (psi, [a, b]) in own {
                let size = libm::sqrt(a * a + b * b) * (1.0 + 8.0 * f64::EPSILON);
                *sizes.entry(psi).or_default() += part.multiplier * size;
            }
        }
        let whole = Polynomial::new(sizes.iter().map(|(psi, &k)| (psi, k)));
        let ceiling = parts.iter().map(|part| part.cap * part.multiplier).sum();
        Self { parts, whole: Residual::new(whole, domain, position_bound), ceiling }
    }

    /// Bounds the sum over `region`, which sees all joints, by best-first branch and bound.
    pub fn range(&self, region: &Region, stop: &Stop) -> Range {
        let mut scratch = Scratch::default();
        let mut queue = Queue::new();
        let (mut found, upper, split) = self.enclose(region, &region.root, &mut scratch);
        queue.push(upper, (region.root, split));
        let mut count = 1;
        while let Some((upper, (cell, split))) = queue.pop() {
            let near = upper <= found * (1.0 + stop.tolerance);
            let settled = stop.limit.is_some_and(|limit| upper <= limit || found > limit);
            if near || settled || count >= stop.cells || !divisible(&cell, split) {
                return Range { found, upper };
            }
            for half in halves(&cell, split) {
                count += 1;
                let (centre, most, split) = self.enclose(region, &half, &mut scratch);
                found = found.max(centre);
                queue.push(most.min(upper), (half, split));
            }
        }
        Range { found, upper: found }
    }

    /// The sum at the centre, its upper bound over the cell, and the variable to halve.
    fn enclose(&self, region: &Region, cell: &Cell, scratch: &mut Scratch) -> (f64, f64, usize) {
        let frame = region.frame(cell);
        let time = region.joints.len();
        let own = &self.whole.polynomial.joints;
        let mut votes = [0.0; MAX_VARIABLES];
        let mut sum = Jet::default();
        let (mut centre, mut beside) = (0.0, 0.0);
        for part in &self.parts {
            let [residual] = part.vertices else {
                let (here, most, variable) = largest(part, &frame, time, scratch);
                centre += here * part.multiplier;
                beside += most * part.multiplier;
                votes[variable] += (most - here) * part.multiplier;
                continue;
            };
            let joints = &residual.polynomial.joints;
            let seen = frame.only(joints);
            let jet = residual.jet(&seen, scratch);
            let (u, size) = (part.multiplier, jet.value.abs());
            let sign = if jet.value < 0.0 { -1.0 } else { 1.0 };
            centre += size * u;
            let against = residual.enclose(&seen, &jet, -sign);
            if against.upper > 0.0 {
                let along = residual.enclose(&seen, &jet, sign);
                let (worse, most) =
                    if against.upper > along.upper { (against, against.upper) } else { (along, along.upper) };
                let most = most.min(part.cap);
                let unsure = 2.0 * against.upper;
                let variable = joints.get(worse.split).copied().unwrap_or(time);
                if unsure > UNSURE * most {
                    beside += most * u;
                    votes[variable] += (most - size) * u;
                    continue;
                }
                beside += unsure * u;
                votes[variable] += unsure * u;
            }
            add(&mut sum, &jet, sign * u, joints, own);
        }
        let enclosed = self.whole.enclose(&frame.only(own), &sum, 1.0);
        let upper = (enclosed.upper + beside).min(self.ceiling);
        votes[own.get(enclosed.split).copied().unwrap_or(time)] += enclosed.upper - sum.value;
        let splittable = |i: usize| cell.high[i] > cell.low[i];
        let split = (0..region.variables()).fold(0, |best, i| {
            if splittable(i) && (votes[i] > votes[best] || !splittable(best)) { i } else { best }
        });
        (centre, upper, split)
    }
}

/// max |r_m| over the vertices of `part` at the centre, its upper bound over the cell, and the variable to halve.
fn largest(part: &Part, frame: &Frame, time: usize, scratch: &mut Scratch) -> (f64, f64, usize) {
    let (mut here, mut most, mut variable) = (0.0_f64, 0.0_f64, time);
    for residual in part.vertices {
        let joints = &residual.polynomial.joints;
        let seen = frame.only(joints);
        let jet = residual.jet(&seen, scratch);
        here = here.max(jet.value.abs());
        for sign in [1.0, -1.0] {
            let enclosed = residual.enclose(&seen, &jet, sign);
            if enclosed.upper > most {
                (most, variable) = (enclosed.upper, joints.get(enclosed.split).copied().unwrap_or(time));
            }
        }
    }
    (here, most.min(part.cap), variable)
}

/// sum += k jet, where `jet` is over the joints `from` and `sum` over `to`.
fn add(sum: &mut Jet, jet: &Jet, k: f64, from: &[usize], to: &[usize]) {
    sum.value += k * jet.value;
    let mut place = [0; MAX_JOINTS];
    for (slot, joint) in place.iter_mut().zip(from) {
        *slot = to.iter().position(|other| other == joint).unwrap_or(0);
    }
    for i in 0..from.len() {
        sum.gradient[place[i]] += k * jet.gradient[i];
        for j in 0..from.len() {
            sum.hessian[place[i]][place[j]] += k * jet.hessian[i][j];
        }
    }
}
