//! Equations (9) and (10) by dense sampling: the largest residual that was seen, not a proof.

use rayon::prelude::*;

use crate::lagrangian::{Combination, Lagrangian, evaluate};
use crate::measure::Domain;
use crate::motion::Motion;
use crate::reduction::Reduced;
use crate::spread::{Spread, corner, in_box};

/// Instants of the motion.
const INSTANTS: u32 = 400;
/// Position errors at each instant, besides the corners of the box.
const ERRORS: usize = 8;
/// Points of a workspace.
const WORKSPACE_POINTS: usize = 20_000;

/// The largest |α_m − α̂_m| seen over the domain, one for each coefficient.
pub fn sampled(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    domain: &Domain,
    motion: Option<&Motion>,
) -> Vec<f64> {
    let count = lagrangian.coefficients.len();
    let residuals: Vec<Combination> = (0..count)
        .map(|m| if reduced.simplified[m] { reduced.residual(lagrangian, m) } else { Vec::new() })
        .collect();
    if residuals.iter().all(Vec::is_empty) {
        return vec![0.0; count];
    }
    // A maximum does not depend on the order in which threads find it.
    points(domain, motion)
        .par_iter()
        .map(|q| {
            let psi = lagrangian.evaluate_functions(q);
            residuals.iter().map(|terms| evaluate(terms, &psi).abs()).collect()
        })
        .reduce(|| vec![0.0; count], |a: Vec<f64>, b| a.iter().zip(b).map(|(a, b)| a.max(b)).collect())
}

fn points(domain: &Domain, motion: Option<&Motion>) -> Vec<Vec<f64>> {
    let errors: &[f64] = match (domain, motion) {
        (Domain::Workspace(limits), _) => return workspace(limits),
        (Domain::Tube(errors), Some(_)) => errors,
        _ => &[],
    };
    let Some(motion) = motion else { return Vec::new() };
    let mut points = Vec::new();
    let spread = Spread::new(errors.len());
    for k in 0..=INSTANTS {
        let q = motion.at(motion.duration() * f64::from(k) / f64::from(INSTANTS)).q;
        let moved = |unit: &[f64]| -> Vec<f64> {
            q.iter().zip(errors).zip(unit).map(|((q, e), u)| q + e * (2.0 * u - 1.0)).collect()
        };
        if errors.iter().any(|&e| e > 0.0) {
            let corners = 1_usize << errors.len();
            // All corners of a small arm's box, a changing quarter of a large one's.
            let stride = if corners > 16 { corners / 16 } else { 1 };
            for index in (k as usize % stride..corners).step_by(stride) {
                points.push(moved(&corner(index, errors.len())));
            }
            points.extend((0..ERRORS).map(|c| moved(&spread.point(k as usize * ERRORS + c))));
        }
        points.push(q);
    }
    points
}

fn workspace(limits: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let n = limits.len();
    let spread = Spread::new(n);
    let inner = (0..WORKSPACE_POINTS).map(|index| spread.point(index));
    inner.chain((0..1 << n).map(|index| corner(index, n))).map(|unit| in_box(limits, &unit)).collect()
}
