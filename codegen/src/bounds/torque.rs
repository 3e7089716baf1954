//! What the left-out terms can cost in torque.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::rates::Rates;
use super::region::{Region, position_bound};
use super::residual::Residual;
use super::sum::{Part, Stop};
use super::weighted::Weighted;
use super::{Certificate, lattice, residuals, rounding};
use crate::arm::Arm;
use crate::domain::Domain;
use crate::dynamics::inverse_dynamics;
use crate::lagrangian::Lagrangian;
use crate::motion::Motion;
use crate::reduction::Reduced;

/// Terms that all boxes of one joint may visit together.
const TERMS: usize = 20_000_000;
/// Boxes of one joint around a motion at most.
const BOXES: usize = 10_000;
/// The same where a limit is to be kept.
const BOXES_WITHIN: usize = 6_000;
/// Cells of one joint over a workspace, where they cost little.
const CELLS: usize = 50_000;
/// Where bound and largest value found differ by less than this fraction, halving stops.
const TOLERANCE: f64 = 0.02;
/// Instants of the motion at which its torque is taken.
const INSTANTS: u32 = 1000;

/// Torque errors and what they are compared with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Torque {
    /// Certified bound on the torque error by joint, N·m or N, for rates up to the motion's own, over a workspace up to
    /// the joints' limits.
    pub error: Vec<f64>,
    /// Largest torque of the exact model found by joint, N·m or N: along the motion, or over the workspace at the same
    /// rates. It is attained, so the true peak is no smaller, and the error no larger a part of it.
    pub peak: Vec<f64>,
    /// The part of the error that is rounding in f64, N·m or N.
    pub rounding: Vec<f64>,
    /// The rates for which the error holds.
    pub rates: Rates,
}

/// The torque error that a tracking law meets: the motion's own rates with what feedback adds to them.
#[derive(Clone, Debug, PartialEq)]
pub struct Met {
    /// Largest |q̇|, |v_r| and |a_r| while the errors stay in their envelope.
    pub rates: Rates,
    /// Certified bound on |δD a_r + δC v_r + δG| by joint, N·m or N, for these rates, inside the domain.
    pub error: Vec<f64>,
}

impl Torque {
    /// The largest error as a fraction of its joint's peak torque; infinite where a joint takes no torque but rounding.
    pub fn fraction(&self) -> f64 {
        let part = |i: usize| match self.error[i] {
            0.0 => 0.0,
            _ if self.is_still(i) => f64::INFINITY,
            error => error / self.peak[i],
        };
        (0..self.error.len()).map(part).fold(0.0, f64::max)
    }

    /// Whether joint `i` takes no torque that can be told from rounding.
    pub fn is_still(&self, i: usize) -> bool {
        self.peak[i] <= self.rounding[i]
    }
}

/// Bound on the torque error |δD a_r + δC v_r + δG| by joint, N·m or N, over the domain and all rates up to `rates`.
///
/// Σ_m |r_m(q)| Ū_m is bounded at each q rather than by the separate maxima of its terms; never more than Σ Δα_m Ū_m.
pub fn torque_error(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    certificates: &[Certificate],
    rates: &Rates,
) -> Vec<f64> {
    let sums = Sums::new(lagrangian, reduced, domain);
    let joints = 0..lagrangian.dof;
    joints.into_par_iter().map(|i| sums.bound(i, rates, certificates, None)).collect()
}

/// Σ_m Δα_m Ū_m by joint, N·m or N: what the torque error cannot exceed even where all residuals are largest at once.
pub fn separate_error(lagrangian: &Lagrangian, certificates: &[Certificate], rates: &Rates) -> Vec<f64> {
    let sum = |i: usize| {
        let multipliers = rates.multipliers(lagrangian, i);
        let sum: f64 = certificates.iter().zip(&multipliers).map(|(c, u)| c.bound * u).sum();
        (sum * (1.0 + rounding::gamma(1024.0))).next_up()
    };
    (0..lagrangian.dof).map(sum).collect()
}

/// Whether the torque error is certified to stay within `limits` by joint, N·m or N: `None` where it is, otherwise a
/// joint where it was found above or could not be certified within the budget.
///
/// What holds of some limits holds of larger ones.
pub fn torque_exceeds(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    certificates: &[Certificate],
    rates: &Rates,
    limits: &[f64],
) -> Option<usize> {
    let sums = Sums::new(lagrangian, reduced, domain);
    let within = |i: &usize| sums.bound(*i, rates, certificates, Some(limits[*i])) <= limits[*i];
    (0..lagrangian.dof).into_par_iter().find_first(|i| !within(i))
}

/// What the torque errors of all joints are made of.
struct Sums<'a> {
    lagrangian: &'a Lagrangian,
    reduced: &'a Reduced,
    domain: &'a Domain,
    /// At the vertices of the uncertain parameters' box.
    residuals: Vec<Vec<Residual>>,
    position_bound: Vec<f64>,
}

impl<'a> Sums<'a> {
    fn new(lagrangian: &'a Lagrangian, reduced: &'a Reduced, domain: &'a Domain) -> Self {
        let residuals = residuals(lagrangian, reduced, domain);
        Self { lagrangian, reduced, domain, residuals, position_bound: position_bound(domain) }
    }

    /// The bound for joint `i`.
    fn bound(&self, i: usize, rates: &Rates, certificates: &[Certificate], limit: Option<f64>) -> f64 {
        let multipliers = rates.multipliers(self.lagrangian, i);
        let mut extra = 0.0;
        let mut parts = Vec::new();
        let mut terms = Vec::new();
        let mut count = 0;
        for (m, vertices) in self.residuals.iter().enumerate() {
            extra += multipliers[m] * certificates[m].sines;
            if vertices.is_empty() || multipliers[m] <= 0.0 {
                continue;
            }
            extra +=
                multipliers[m] * rounding::published(self.lagrangian, m, self.reduced, &self.position_bound);
            let cap = certificates[m].bound;
            parts.push(Part { vertices, multiplier: multipliers[m], cap });
            // Several vertices are enclosed by themselves.
            let left =
                if vertices.len() == 1 { self.reduced.residual(self.lagrangian, m) } else { Vec::new() };
            count += vertices.iter().map(|residual| residual.polynomial.terms().count()).sum::<usize>();
            terms.push(left.iter().map(|&(l, k)| (&self.lagrangian.functions[l], k)).collect::<Vec<_>>());
        }
        let separate: f64 = certificates.iter().zip(&multipliers).map(|(c, u)| c.bound * u).sum();
        if parts.is_empty() && separate == 0.0 {
            return 0.0;
        }
        let slack = 1.0 + rounding::gamma(1024.0);
        let most = match (self.domain, limit) {
            (Domain::Workspace(_), _) => CELLS,
            (_, Some(_)) => BOXES_WITHIN,
            (_, None) => BOXES,
        };
        let limit = limit.map(|limit| (limit / slack - extra) * (1.0 - f64::EPSILON));
        let cells = (TERMS / count.max(1)).clamp(16, most);
        let joints: Vec<usize> = (0..self.lagrangian.dof).collect();
        let stop = Stop { tolerance: TOLERANCE, cells, limit };
        let range = match self.domain {
            Domain::Workspace(limits) => lattice::range(&parts, limits, &stop),
            _ => {
                let region = Region::new(self.domain, &joints);
                Weighted::new(parts, &terms, self.domain, &self.position_bound).range(&region, &stop)
            }
        };
        let bound = ((range.upper + extra).min(separate) * slack).next_up();
        if bound < f64::MIN_POSITIVE { 0.0 } else { bound }
    }
}

/// Largest |τ| by joint at some instants of the motion, N·m or N, without friction: attained, so the true peak is no
/// smaller. Good to measure errors by, not to judge limits by.
pub fn peak_torque(arm: &Arm, motion: &Motion) -> Vec<f64> {
    let mut peak = vec![0.0_f64; arm.dof()];
    for k in 0..=INSTANTS {
        let target = motion.at(motion.duration() * f64::from(k) / f64::from(INSTANTS));
        let torque = inverse_dynamics(arm, &target.q, &target.qd, &target.qdd);
        peak.iter_mut().zip(torque).for_each(|(peak, tau)| *peak = peak.max(tau.abs()));
    }
    peak
}
