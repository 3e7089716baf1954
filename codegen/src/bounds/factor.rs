//! The report's bounds for a law that learns, by a factor on those of the arm itself: for comparison, not to rely on.
//!
//! Section 3.3 of the report spares itself the search over all arms: where the inertial parameter θ_i may be k_i times
//! its value, Δα_m "cannot differ from its counterpart for nominal dynamics by more than the factor"
//! k_m = 1 + max_i |1 − k_i|, over the θ_i that multiply a function of α_m which was left out.
//!
//! That holds where all that is left out of α_m varies together. What is left out is r + Σ_i θ_i r_i, with r of the
//! parameters that are known; where r and θ_i r_i have opposite signs, the nominal sum is smaller than its parts, and a
//! change of θ_i by a fifth changes it by more than a fifth. One uncertain mass suffices: in the report's own example the
//! point mass at the end of link 3 and the first moment of the rod behind it pull against each other. So the factor is
//! published beside the exact bound, which the law relies on, and never instead of it.

use super::{Certificate, Effort, certified};
use crate::arm::{Parameter, Uncertainty};
use crate::domain::Domain;
use crate::lagrangian::Lagrangian;
use crate::reduction::Reduced;

/// k_m = 1 + max_i |1 − k_i|: infinite where such a parameter is 0 for the arm itself, 1 where none varies.
pub fn factor(lagrangian: &Lagrangian, reduced: &Reduced, uncertainty: &Uncertainty, m: usize) -> f64 {
    let left_out = |k: usize| {
        lagrangian.coefficients[m].variations[k].iter().any(|(l, _)| !reduced.selected.contains(l))
    };
    let varies = |(k, p): (usize, &Parameter)| {
        if !(reduced.simplified[m] && left_out(k)) {
            return 0.0;
        }
        p.high.max(-p.low) / p.nominal.abs()
    };
    1.0 + uncertainty.parameters.iter().enumerate().map(varies).fold(0.0, f64::max)
}

/// k_m Δα_m for every coefficient, Δα_m the certified bound of the arm itself.
pub fn factor_bounds(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    uncertainty: &Uncertainty,
    domain: &Domain,
    effort: &Effort,
) -> Vec<f64> {
    let known = Lagrangian { ranges: vec![[0.0; 2]; lagrangian.ranges.len()], ..lagrangian.clone() };
    let own: Vec<Certificate> = certified(&known, reduced, domain, effort);
    let scaled = |(m, own): (usize, &Certificate)| {
        if own.bound == 0.0 { 0.0 } else { own.bound * factor(lagrangian, reduced, uncertainty, m) }
    };
    own.iter().enumerate().map(scaled).collect()
}
