//! What recursive code is off by: sines that are off by more than rounding, rotations that were rounded, and f64.
//!
//! In the recursion sin² + cos² = 1 is used without being computed, so its error is not that of an expansion. It follows
//! from the recursion over norms ([`crate::dynamics::Sizes`]), entry by entry of D, h and G, also where the exact entry is
//! zero.

use super::Bounds;
use super::rounding::{gamma, monomial};
use crate::arm::{Arm, Uncertainty};
use crate::dynamics::{Size, Sizes};
use crate::lagrangian::{Combination, Lagrangian};

/// Bounds on what the recursive body of `arm` is off by, where |q_j| ≤ `position_bound` for prismatic joints and every sine and
/// cosine is off by `sine`.
pub fn recursion(arm: &Arm, position_bound: &[f64], sine: f64) -> Bounds {
    Bounds::from_sizes(&Sizes::with_sines(arm, position_bound, sine), changed)
}

/// Bounds on what the model of `arm` differs by from that of the arm as `given`, whose rotations have not been rounded,
/// where |q_j| ≤ `position_bound` for prismatic joints; `None` where they are the same.
///
/// Uncertain numbers stand for any value in their box: the change is convex in them, so it is largest at a vertex.
pub fn rounded_angles(
    (arm, uncertainty): (&Arm, &Uncertainty),
    (given, uncertain): (&Arm, &Uncertainty),
    position_bound: &[f64],
) -> Option<Bounds> {
    if arm == given {
        return None;
    }
    let at = |u: &[f64]| {
        let (arm, given) = (uncertainty.at(arm, u), uncertain.at(given, u));
        Bounds::from_sizes(&Sizes::beside(&arm, &given, position_bound), changed)
    };
    let nominal = at(&vec![0.0; uncertainty.parameters.len()]);
    Some(uncertainty.vertices().fold(nominal, |most, u| most.largest(&at(&u))))
}

/// The change, and roundings of code that is as long as a recursion.
fn changed(size: Size) -> f64 {
    if size.change == 0.0 {
        0.0
    } else {
        (size.change + gamma(1024.0) * (size.exact + size.change)).next_up()
    }
}

/// Roundings of a recursion, times what its constants may exceed the parameters by that they were made of: a body keeps
/// at most 30 times what was gathered on it, a few sums of products make each constant and some thousand the torque.
const MOVES: f64 = 131_072.0;

/// Bounds on the rounding in f64 of the recursive body of `arm`, where |q_j| ≤ `position_bound` for prismatic joints and sines and
/// cosines are as good as rounding: a part of the recursion over norms, which bounds whatever is summed on the way.
pub fn recursion_rounding(arm: &Arm, position_bound: &[f64]) -> Bounds {
    // Where nothing is summed, nothing rounds.
    let rounding = |size: Size| if size.exact == 0.0 { 0.0 } else { (gamma(MOVES) * size.exact).next_up() };
    Bounds::from_sizes(&Sizes::new(arm, position_bound), rounding)
}

/// By coefficient, what the recursive body of `arm` may be off by from `combinations`, its expansion, which lack `lacking`,
/// where |q_j| ≤ `position_bound`.
pub fn beside_expansion(
    lagrangian: &Lagrangian,
    combinations: &[Combination],
    lacking: &[f64],
    arm: &Arm,
    position_bound: &[f64],
) -> Vec<f64> {
    let largest = position_bound.iter().fold(1.0, |p: f64, &q| p * (q * q).max(1.0));
    let own = recursion_rounding(arm, position_bound).certificates(lagrangian);
    let all = own.iter().zip(combinations).zip(lacking);
    all.map(|((own, terms), lacking)| {
        let sum: f64 = terms.iter().map(|&(l, k)| k.abs() * monomial(lagrangian, l, position_bound)).sum();
        (own.bound + gamma(1024.0) * sum + lacking * largest).next_up()
    })
    .collect()
}
