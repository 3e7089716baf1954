//! What the left-out terms can cost in torque.

use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::branch::{Waiting, divisible, halves};
use super::polynomial::Scratch;
use super::region::{Cell, Region, reach};
use super::residual::Residual;
use super::{Certificate, residuals, rounding};
use crate::arm::{Arm, Uncertainty};
use crate::dynamics::inverse_dynamics;
use crate::lagrangian::{Entry, Lagrangian};
use crate::measure::Domain;
use crate::motion::Motion;
use crate::reduction::Reduced;

/// Terms that all boxes of one joint may visit together.
const TERMS: usize = 20_000_000;
/// Boxes of one joint at most.
const BOXES: usize = 4000;
/// Where bound and largest value found differ by less than this fraction, halving stops.
const TOLERANCE: f64 = 0.02;
/// Instants of the motion at which its torque is taken.
const INSTANTS: u32 = 1000;

/// The largest rates that multiply D, h and G in the law, by joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// |q̇|, rad/s or m/s.
    pub speed: Vec<f64>,
    /// |v_r|, rad/s or m/s.
    pub reference_speed: Vec<f64>,
    /// |a_r|, rad/s² or m/s².
    pub reference_acceleration: Vec<f64>,
}

impl Rates {
    /// The motion's own: q̇ = v_r = q̇_d and a_r = q̈_d.
    pub fn of(motion: &Motion) -> Self {
        let reach = motion.reach();
        let (speed, acceleration) = (reach.speed, reach.acceleration);
        Self { reference_speed: speed.clone(), speed, reference_acceleration: acceleration }
    }

    /// The joints' limits; `None` where one is missing.
    pub fn limits(arm: &Arm) -> Option<Self> {
        let speed: Vec<f64> = arm.joints.iter().map(|joint| joint.limits.velocity).collect::<Option<_>>()?;
        let acceleration = arm.joints.iter().map(|joint| joint.limits.acceleration).collect::<Option<_>>()?;
        Some(Self { reference_speed: speed.clone(), speed, reference_acceleration: acceleration })
    }

    /// Ū_m of row `i`: the most that multiplies α_m there, over all its places.
    pub(crate) fn multipliers(&self, lagrangian: &Lagrangian, i: usize) -> Vec<f64> {
        let (a, v, w) = (&self.reference_acceleration, &self.speed, &self.reference_speed);
        let of = |entry: Entry| match entry {
            Entry::D(r, c) if r == i => a[c],
            Entry::D(r, c) if c == i => a[r],
            Entry::H(r, j, k) if r == i && j == k => v[j] * w[j],
            Entry::H(r, j, k) if r == i => v[j] * w[k] + v[k] * w[j],
            Entry::G(r) if r == i => 1.0,
            _ => 0.0,
        };
        let sum = |c: &crate::lagrangian::Coefficient| c.places.iter().map(|place| of(place.entry)).sum();
        lagrangian.coefficients.iter().map(sum).collect()
    }
}

/// Bound on the torque error |δD a_r + δC v_r + δG| by joint, N·m or N, over the domain and all rates up to `rates`.
///
/// Σ_m |r_m(q)| Ū_m is bounded at each q rather than by the separate maxima of its terms; never more than Σ Δα_m Ū_m.
pub fn torque_error(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    motion: Option<&Motion>,
    certificates: &[Certificate],
    rates: &Rates,
) -> Vec<f64> {
    let residuals = residuals(lagrangian, reduced, domain, motion);
    let reach = reach(domain, motion);
    let joints: Vec<usize> = (0..lagrangian.dof).collect();
    let region = Region::new(domain, motion, &joints);
    joints
        .par_iter()
        .map(|&i| {
            let multipliers = rates.multipliers(lagrangian, i);
            let separate: f64 = certificates.iter().zip(&multipliers).map(|(c, u)| c.bound * u).sum();
            let mut extra = 0.0;
            let mut parts = Vec::new();
            for (m, vertices) in residuals.iter().enumerate() {
                extra += multipliers[m] * certificates[m].sines;
                if vertices.is_empty() || multipliers[m] <= 0.0 {
                    continue;
                }
                extra += multipliers[m] * rounding::published(lagrangian, m, reduced, &reach);
                let cap = certificates[m].bound;
                parts.push(Part { vertices, multiplier: multipliers[m], cap });
            }
            let sum = largest_sum(&parts, &region) + extra;
            (sum.min(separate) * (1.0 + rounding::gamma(1024.0))).next_up()
        })
        .map(|bound| if bound < f64::MIN_POSITIVE { 0.0 } else { bound })
        .collect()
}

/// Largest |τ| by joint along the motion, N·m or N, without friction.
pub fn peak_torque(arm: &Arm, motion: &Motion) -> Vec<f64> {
    largest_torque(arm, &Uncertainty::default(), motion)
}

/// The same of any arm of a family: τ is affine in the uncertain parameters.
pub fn largest_torque(arm: &Arm, uncertainty: &Uncertainty, motion: &Motion) -> Vec<f64> {
    let alone: Vec<Arm> = (0..uncertainty.parameters.len()).map(|k| uncertainty.alone(arm, k)).collect();
    let mut peak = vec![0.0_f64; arm.dof()];
    for k in 0..=INSTANTS {
        let target = motion.at(motion.duration() * f64::from(k) / f64::from(INSTANTS));
        let torque = |arm: &Arm| inverse_dynamics(arm, &target.q, &target.qd, &target.qdd);
        let slopes: Vec<Vec<f64>> = alone.iter().map(torque).collect();
        let largest = uncertainty.largest(&torque(arm), &slopes);
        peak.iter_mut().zip(largest).for_each(|(peak, tau)| *peak = peak.max(tau));
    }
    peak
}

struct Part<'a> {
    /// The residual at the vertices of the box of uncertain parameters; |r_m| is the largest of them.
    vertices: &'a [Residual],
    multiplier: f64,
    cap: f64,
}

/// An upper bound on max Σ_m |r_m| Ū_m, by best-first branch and bound.
fn largest_sum(parts: &[Part], region: &Region) -> f64 {
    let residuals = parts.iter().flat_map(|part| part.vertices);
    let terms: usize = residuals.map(|residual| residual.polynomial.terms().count()).sum();
    let budget = (TERMS / terms.max(1)).clamp(16, BOXES);
    let mut scratch = Scratch::default();
    let mut enter = |cell: Cell, number: usize, parent: f64| {
        let (centre, upper, split) = enclose(parts, region, &cell, &mut scratch);
        (
            centre,
            Waiting {
                upper: upper.min(parent),
                number,
                residual: 0,
                sign: 1.0,
                split,
                cell,
                expansion: None,
            },
        )
    };
    let mut heap = BinaryHeap::new();
    let (mut found, root) = enter(region.root, 0, f64::INFINITY);
    heap.push(root);
    let mut count = 1;
    while let Some(top) = heap.pop() {
        let near = top.upper <= found * (1.0 + TOLERANCE);
        if near || count >= budget || !divisible(&top.cell, top.split) {
            return top.upper;
        }
        for cell in halves(&top.cell, top.split) {
            count += 1;
            let (centre, waiting) = enter(cell, count, top.upper);
            found = found.max(centre);
            heap.push(waiting);
        }
    }
    0.0
}

/// Σ|r_m|Ū_m at the centre, its upper bound over the cell, and the variable to halve: the votes of the parts are
/// weighed by what each adds above its centre.
fn enclose(parts: &[Part], region: &Region, cell: &Cell, scratch: &mut Scratch) -> (f64, f64, usize) {
    let whole = region.frame(cell);
    let time = region.joints.len();
    let mut votes = [0.0; super::region::MAX_VARIABLES];
    let (mut centre, mut upper) = (0.0, 0.0);
    for part in parts {
        let (mut here, mut most, mut vote) = (0.0_f64, f64::MIN, time);
        for residual in part.vertices {
            let joints = &residual.polynomial.joints;
            let frame = whole.only(joints);
            let jet = residual.jet(&frame, scratch);
            let [rising, falling] = [1.0, -1.0].map(|sign| residual.enclose(&frame, &jet, sign));
            let worse = if rising.upper >= falling.upper { rising } else { falling };
            here = here.max(jet.value.abs());
            if worse.upper > most {
                (most, vote) = (worse.upper, joints.get(worse.split).copied().unwrap_or(time));
            }
        }
        centre += here * part.multiplier;
        upper += most.min(part.cap) * part.multiplier;
        votes[vote] += (most - here) * part.multiplier;
    }
    let splittable = |i: usize| cell.high[i] > cell.low[i];
    let split = (0..region.variables()).fold(0, |best, i| {
        if splittable(i) && (votes[i] > votes[best] || !splittable(best)) { i } else { best }
    });
    (centre, upper, split)
}
