//! The largest weighted sum of absolute residuals over a box of positions.
//!
//! E(q) = Σ_m Ū_m |r_m(q)| is the largest of the smooth sums Σ ±Ū_m r_m over all signs. Along joint j, between its points
//! a < b, no such sum lies further above the straight line than ½ (x − a)(b − x) B_j, where
//! B_j ≥ Σ_m Ū_m |∂²r_m/∂q_j²|; so neither does E, whichever residuals change their sign in between, nor the largest E
//! over some of the other joints. Taken together joint by joint, the values at the corners of a cell therefore bound E in
//! all of it. Values are cheap where a grid shares what they have in common, and B_j itself is bounded in the same way from
//! the values of Σ_m Ū_m |∂²r_m/∂q_j²| at the corners.

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use crate::bounds::branch::{divisible, halves};
use crate::bounds::grid::each_cell;
use crate::bounds::queue::Queue;
use crate::bounds::region::{Cell, MAX_VARIABLES};
use crate::bounds::rounding::ENCLOSURE;
use crate::bounds::sum::{Part, Range, Stop, Sum};

/// Points of the first grid at most, and intervals of each of its sides.
const POINTS: usize = 8_000;
const INTERVALS: usize = 64;
/// What negligible parts may add together, of the sum of all; joints on which only they depend drop out.
const NEGLIGIBLE: f64 = 1e-3;
/// Covers the rounding of a few sums and products of positive numbers.
const MORE: f64 = 1.0 + 1e-9;

/// Bounds Σ_m Ū_m |r_m| over the box `limits`, one side for each joint of the arm.
pub(super) fn range(parts: &[Part], limits: &[[f64; 2]], stop: &Stop) -> Range {
    let caps: Vec<f64> = parts.iter().map(|part| part.cap * part.multiplier).collect();
    let ceiling: f64 = caps.iter().sum();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by(|&a, &b| caps[a].total_cmp(&caps[b]).then(a.cmp(&b)));
    let mut negligible = 0.0;
    let mut dropped = BTreeSet::new();
    for part in order {
        if negligible + caps[part] > NEGLIGIBLE * ceiling {
            break;
        }
        negligible += caps[part];
        dropped.insert(part);
    }
    let seen = parts.iter().enumerate().filter(|(part, _)| !dropped.contains(part)).map(|(_, part)| part);
    let search = Search::new(Sum::new(seen), limits);
    let range = search.run(&Stop { limit: stop.limit.map(|limit| limit - negligible), ..*stop });
    Range { found: range.found, upper: ((range.upper + negligible) * MORE).min(ceiling) }
}

/// A cell that may hold more than is near enough.
struct Waiting {
    cell: Cell,
    /// B_j over the cell.
    curvature: [f64; MAX_VARIABLES],
}

struct Search<'a> {
    sum: Sum,
    limits: &'a [[f64; 2]],
    /// Rounding of a value.
    rounding: f64,
}

/// What is known so far.
struct Front {
    found: f64,
    /// Bound over all cells that do not wait.
    closed: f64,
    queue: Queue<Waiting>,
    stop: Stop,
}

impl<'a> Search<'a> {
    fn new(sum: Sum, limits: &'a [[f64; 2]]) -> Self {
        let position_bound = limits.iter().flatten().fold(1.0_f64, |most, q| most.max(q.abs()));
        // A term holds at most the fourth power of prismatic coordinates.
        let rounding =
            ENCLOSURE * sum.size * (position_bound * position_bound) * (position_bound * position_bound);
        Self { sum, limits, rounding }
    }

    /// Best-first branch and bound from the cells of a grid.
    fn run(&self, stop: &Stop) -> Range {
        let mut front = Front { found: 0.0, closed: 0.0, queue: Queue::new(), stop: *stop };
        self.first(&mut front);
        let mut halved = 0;
        while let Some((upper, top)) = front.queue.pop() {
            let above = stop.limit.is_some_and(|limit| front.found > limit);
            if upper <= front.near() || above || halved >= stop.cells || !self.halve(&top, upper, &mut front)
            {
                front.closed = front.closed.max(upper);
                break;
            }
            halved += 1;
        }
        Range { found: front.found, upper: front.closed.max(front.found) }
    }

    /// Encloses the cells of the first grid.
    fn first(&self, front: &mut Front) {
        let joints = &self.sum.joints;
        let k = joints.len();
        let axes = self.axes();
        let sizes: Vec<usize> = axes.iter().map(Vec::len).collect();
        let values = self.sum.on_grid(joints, &axes);
        front.found = values.iter().fold(0.0, |most: f64, &value| most.max(value));
        let bends: Vec<(Vec<f64>, Vec<f64>)> = joints
            .iter()
            .map(|&j| {
                let bend = self.sum.curvature(j);
                let own = joints.iter().map(|&i| bend.curvature_within(i, self.limits)).collect();
                (bend.on_grid(joints, &axes), own)
            })
            .collect();
        let mut corners = vec![0.0; 1 << k];
        each_cell(&sizes, |at, index| {
            let mut cell = Cell { low: [0.0; MAX_VARIABLES], high: [0.0; MAX_VARIABLES] };
            for slot in 0..k {
                cell.low[slot] = axes[slot][at[slot]];
                cell.high[slot] = axes[slot][at[slot] + 1];
            }
            let mut gathered = |values: &[f64], curvature: &[f64]| {
                corners.iter_mut().enumerate().for_each(|(c, value)| *value = values[index(c)]);
                folded(&mut corners, &cell, curvature)
            };
            let mut curvature = [0.0; MAX_VARIABLES];
            for (slot, (values, own)) in bends.iter().enumerate() {
                curvature[slot] = gathered(values, own) * MORE + self.rounding * 16.0;
            }
            let upper = gathered(&values, &curvature[..k]) * MORE + self.rounding;
            front.enter(upper, cell, curvature);
        });
    }

    /// Halves the side along which the sum may bend most, where it is `most` at most; false where that side is a point.
    fn halve(&self, top: &Waiting, most: f64, front: &mut Front) -> bool {
        let joints = &self.sum.joints;
        let k = joints.len();
        let Waiting { cell, curvature } = top;
        let bend = |slot: usize| excess(cell, slot, curvature[slot]);
        let split = (0..k).fold(0, |best, slot| if bend(slot) > bend(best) { slot } else { best });
        if !divisible(cell, split) {
            return false;
        }
        let parts = halves(cell, split);
        let mut axes: Vec<Vec<f64>> = (0..k).map(|slot| vec![cell.low[slot], cell.high[slot]]).collect();
        axes[split].insert(1, parts[0].high[split]);
        let sizes: Vec<usize> = axes.iter().map(Vec::len).collect();
        let values = self.sum.on_grid(joints, &axes);
        front.found = values.iter().fold(front.found, |most, &value| most.max(value));
        let mut corners = vec![0.0; 1 << k];
        each_cell(&sizes, |at, index| {
            let half = parts[at[split]];
            corners.iter_mut().enumerate().for_each(|(c, value)| *value = values[index(c)]);
            let upper = folded(&mut corners, &half, &curvature[..k]) * MORE + self.rounding;
            front.enter(upper.min(most), half, *curvature);
        });
        true
    }

    /// Sides of the first grid: between its points each may bend as much as any other.
    fn axes(&self) -> Vec<Vec<f64>> {
        let joints = &self.sum.joints;
        let side = |j: usize| self.limits[j][1] - self.limits[j][0];
        let bend = |&j: &usize| side(j) * libm::sqrt(self.sum.curvature_within(j, self.limits));
        let bends: Vec<f64> = joints.iter().map(bend).collect();
        let largest = bends.iter().fold(f64::MIN_POSITIVE, |most: f64, &bend| most.max(bend));
        let counts = |scale: f64| -> Vec<usize> {
            bends.iter().map(|bend| (libm::ceil(bend * scale) as usize).clamp(1, INTERVALS)).collect()
        };
        let mut scale = INTERVALS as f64 / largest;
        let points = |counts: Vec<usize>| counts.iter().map(|count| count + 1).product::<usize>();
        while scale * largest > 1.0 && points(counts(scale)) > POINTS {
            scale *= 0.95;
        }
        let axis = |(&j, count): (&usize, usize)| {
            let [low, high] = self.limits[j];
            let at = |i: usize| low + (high - low) * i as f64 / count as f64;
            (0..count).map(at).chain([high]).collect()
        };
        joints.iter().zip(counts(scale)).map(axis).collect()
    }
}

impl Front {
    /// The upper bound that is near enough.
    fn near(&self) -> f64 {
        self.stop.limit.unwrap_or(self.found * (1.0 + self.stop.tolerance))
    }

    fn enter(&mut self, upper: f64, cell: Cell, curvature: [f64; MAX_VARIABLES]) {
        if upper <= self.near() {
            self.closed = self.closed.max(upper);
        } else {
            self.queue.push(upper, Waiting { cell, curvature });
        }
    }
}

/// ½ h² B, h half the side `slot` of a cell.
fn excess(cell: &Cell, slot: usize, curvature: f64) -> f64 {
    let half = 0.5 * (cell.high[slot] - cell.low[slot]);
    0.5 * half * half * curvature
}

/// Bound over a cell from the values at its corners, bit j of a corner's number saying which end of side j; `corners` is
/// used up.
fn folded(corners: &mut [f64], cell: &Cell, curvature: &[f64]) -> f64 {
    let mut count = corners.len();
    for (slot, &bend) in curvature.iter().enumerate() {
        let e = excess(cell, slot, bend);
        count /= 2;
        for i in 0..count {
            // The side that is folded is the lowest bit left.
            corners[i] = edge(corners[2 * i], corners[2 * i + 1], e);
        }
    }
    corners[0]
}

/// The largest value on a straight line from `a` to `b` under a parabola of height `e`.
fn edge(a: f64, b: f64, e: f64) -> f64 {
    let half = 0.5 * (b - a).abs();
    if half >= 2.0 * e { a.max(b) } else { 0.5 * (a + b) + e + half * half / (4.0 * e) }
}
