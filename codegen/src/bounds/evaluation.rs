//! What the recursion of an arm that stands for another is off by when it is evaluated.
//!
//! Three things lie between its code and the combinations that the certificates compare with the exact ones:
//!
//! - the roundings of the code. Its nodes are sums and products; with every sum taken over absolute values a node is at
//!   most M, and its value errs by γ_k M, k the most roundings on a way to it (a product has those of both factors).
//!   M is found for unit rates one at a time: it is affine in a_r and bilinear in q̇ and v_r with no negative
//!   coefficient, so these values bound ΔG, ΔD and Δh entry by entry;
//! - the roundings of the constants, where parameters were moved from body to body and frames along axes. A body keeps
//!   at most 30 times what it was summed from, and every move is a few sums of products that the recursion over norms
//!   bounds as well: [`MOVES`] roundings of that, far more than there are;
//! - the roundings of the expansion, γ_1024 Σ|k̂_l| sup|ψ_l|, and what it lacks.

use super::Bounds;
use super::recursion::recursion_size;
use super::rounding::{gamma, monomial};
use crate::arm::Arm;
use crate::graph::Graph;
use crate::lagrangian::{Combination, Lagrangian};

/// Roundings of a constant, times what it may exceed the parameters by that it was made of.
const MOVES: f64 = 32_768.0;

/// By coefficient, what `code`, the recursion of `arm`, may be off by from `combinations`, which lack `lacking`, where
/// |q_j| ≤ `reach`.
pub fn evaluation(
    lagrangian: &Lagrangian,
    combinations: &[Combination],
    lacking: &[f64],
    arm: &Arm,
    code: &Graph,
    reach: &[f64],
) -> Vec<f64> {
    let bounds = rounded(code, arm.dof(), reach).plus(&recursion_size(arm, reach, gamma(MOVES)));
    let largest = reach.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
    let own = bounds.certificates(lagrangian);
    own.iter()
        .zip(combinations)
        .zip(lacking)
        .map(|((own, terms), lacking)| {
            let sum: f64 = terms.iter().map(|&(l, k)| k.abs() * monomial(lagrangian, l, reach)).sum();
            (own.bound + gamma(1024.0) * sum + lacking * largest).next_up()
        })
        .collect()
}

/// Roundings of the code, entry by entry.
fn rounded(code: &Graph, n: usize, reach: &[f64]) -> Bounds {
    let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect() };
    let rest = vec![0.0; n];
    let at = |qd: &[f64], v_r: &[f64], a_r: &[f64]| -> Vec<f64> {
        let outputs = code.magnitudes(reach, qd, v_r, a_r);
        // Twice as many, for those of the magnitudes themselves and of sines and cosines beyond 1.
        outputs.iter().map(|m| (gamma(2.0 * f64::from(m.roundings)) * m.size).next_up()).collect()
    };
    let mut bounds = Bounds {
        d: vec![vec![0.0; n]; n],
        h: vec![vec![vec![0.0; n]; n]; n],
        b: vec![0.0; n],
        g: at(&rest, &rest, &rest),
    };
    for j in 0..n {
        for (row, bound) in bounds.d.iter_mut().zip(at(&rest, &rest, &unit(j))) {
            row[j] = bound;
        }
        for k in 0..n {
            for (plane, bound) in bounds.h.iter_mut().zip(at(&unit(j), &unit(k), &rest)) {
                plane[j][k] = plane[j][k].max(bound);
                plane[k][j] = plane[k][j].max(bound);
            }
        }
    }
    bounds
}
