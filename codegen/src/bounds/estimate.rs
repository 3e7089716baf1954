//! Equation (11): a quick estimate of the bounds, not a proof.

use rayon::prelude::*;

use super::polynomial::Scratch;
use super::region::Region;
use super::residuals;
use crate::domain::Domain;
use crate::lagrangian::Lagrangian;
use crate::reduction::Reduced;

/// Instants of the motion.
const INSTANTS: u32 = 200;

/// max over t of |r_m(q_d)| + Σ_j |∂r_m/∂q_j| ε_j, one for each coefficient; `None` over a workspace, which has no
/// motion to go along.
pub fn estimate(lagrangian: &Lagrangian, reduced: &Reduced, domain: &Domain) -> Option<Vec<f64>> {
    let motion = domain.motion()?;
    let largest = |residual: &super::Residual| {
        let region = Region::new(domain, &residual.polynomial.joints);
        let k = region.joints.len();
        let mut scratch = Scratch::default();
        let mut x = vec![0.0; k + 1];
        let mut at = |t: u32| {
            x[k] = motion.duration() * f64::from(t) / f64::from(INSTANTS);
            let jet = residual.jet(&region.frame(&Region::point(&x)), &mut scratch);
            (0..k).fold(jet.value.abs(), |sum, i| sum + jet.gradient[i].abs() * region.root.high[i])
        };
        (0..=INSTANTS).map(&mut at).fold(0.0, f64::max)
    };
    let residuals = residuals(lagrangian, reduced, domain);
    Some(residuals.par_iter().map(|vertices| vertices.iter().map(largest).fold(0.0, f64::max)).collect())
}
