//! The largest torque error of a sparse model that a search finds.

use rayon::prelude::*;

use crate::lagrangian::{Combination, Lagrangian, evaluate};
use crate::measure::Domain;
use crate::reduction::Reduced;

/// Points from which each joint's error is followed uphill.
const STARTS: usize = 3;
/// Steps as fractions of the domain's sides.
const STEPS: [f64; 5] = [0.2, 0.1, 0.04, 0.015, 0.005];

/// Largest Σ_m |r_m| `shares`_im over joints and positions; around a motion, whose instants `points` sample densely,
/// at the points alone.
pub(super) fn largest(
    lagrangian: &Lagrangian,
    reduced: &Reduced,
    shares: &[Vec<f64>],
    domain: &Domain,
    points: &[Vec<f64>],
) -> f64 {
    let residuals: Vec<Combination> =
        (0..reduced.combinations.len()).map(|m| reduced.residual(lagrangian, m)).collect();
    let at = |q: &[f64]| -> Vec<f64> {
        let psi = lagrangian.evaluate_functions(q);
        let left: Vec<f64> = residuals.iter().map(|terms| evaluate(terms, &psi).abs()).collect();
        shares.iter().map(|row| row.iter().zip(&left).map(|(u, r)| u * r).sum()).collect()
    };
    let seen: Vec<Vec<f64>> = points.par_iter().map(|q| at(q)).collect();
    let joints = (0..shares.len()).into_par_iter();
    let found: Vec<f64> = joints
        .map(|i| {
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&a, &b| seen[b][i].total_cmp(&seen[a][i]).then(a.cmp(&b)));
            let start = order.first().map_or(0.0, |&index| seen[index][i]);
            let Domain::Workspace(limits) = domain else { return start };
            order.iter().take(STARTS).fold(start, |best, &index| {
                best.max(climb(&points[index], seen[index][i], limits, &|q| at(q)[i]))
            })
        })
        .collect();
    found.into_iter().fold(0.0, f64::max)
}

/// Uphill along single joints.
fn climb(from: &[f64], height: f64, limits: &[[f64; 2]], f: &dyn Fn(&[f64]) -> f64) -> f64 {
    let (mut q, mut height) = (from.to_vec(), height);
    for step in STEPS {
        let mut moved = true;
        let mut rounds = 0;
        while moved && rounds < 4 {
            (moved, rounds) = (false, rounds + 1);
            for (j, [low, high]) in limits.iter().enumerate() {
                for turn in [step, -step] {
                    let mut next = q.clone();
                    next[j] = (q[j] + turn * (high - low)).clamp(*low, *high);
                    let there = f(&next);
                    if there > height {
                        (q, height, moved) = (next, there, true);
                    }
                }
            }
        }
    }
    height
}
