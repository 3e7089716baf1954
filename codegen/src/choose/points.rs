//! Positions at which torque errors are looked at.

use crate::domain::Domain;
use crate::lagrangian::{Combination, Lagrangian, evaluate};
use crate::numerics::low_discrepancy::{LowDiscrepancy, corner, in_box};
use crate::parallel::Parallelize;
use crate::reduction::Reduced;

/// Points of the domain at which the family of models is fitted, besides corners.
const POINTS: usize = 400;
/// Of so many points one is looked at before a proof.
const SEEN: usize = 3;
/// How far points are spread beyond a workspace before they are moved back to its sides, where errors are largest.
const STRETCH: f64 = 1.5;
/// Corners of the joint box beside them.
const CORNERS: usize = 32;

/// Whether Σ_m |r_m| `shares`_im is within `fraction` for all joints and every third of `points`: what is not within it is
/// seen at little cost before a proof of it is sought in vain.
pub(super) fn seen_within(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    shares: &[Vec<f64>],
    points: &[Vec<f64>],
    fraction: f64,
) -> bool {
    let residuals: Vec<Combination> =
        (0..reduced.combinations.len()).map(|m| reduced.residual(lagrangian, m)).collect();
    let at = |q: &Vec<f64>| {
        let psi = lagrangian.evaluate_functions(q);
        let left: Vec<f64> = residuals.iter().map(|terms| evaluate(terms, &psi).abs()).collect();
        let row = |row: &Vec<f64>| row.iter().zip(&left).map(|(u, r)| u * r).sum::<f64>();
        shares.iter().map(row).fold(0.0, f64::max)
    };
    // A proof is to follow, which holds at the others: they are left to it.
    let some: Vec<&Vec<f64>> = points.iter().step_by(SEEN).collect();
    some.into_par_iter().find_first(|q| at(q) > fraction).is_none()
}

/// Points of the domain to fit to: few, evenly spread, with sides and corners.
pub(super) fn points(domain: &Domain, all: &[Vec<f64>]) -> Vec<Vec<f64>> {
    match domain {
        Domain::Workspace(limits) => {
            let n = limits.len();
            let spread = LowDiscrepancy::new(n);
            let side = |u: &f64| (0.5 + STRETCH * (u - 0.5)).clamp(0.0, 1.0);
            let some = (0..POINTS).map(|index| spread.point(index).iter().map(side).collect::<Vec<_>>());
            let corners = 1_usize << n;
            let some_corners = (0..corners).step_by((corners / CORNERS).max(1)).map(|index| corner(index, n));
            some.chain(some_corners).map(|unit| in_box(limits, &unit)).collect()
        }
        // An odd stride, so that instants and sides of the box both take turns.
        _ => all.iter().step_by((all.len() / POINTS).max(1) | 1).cloned().collect(),
    }
}
