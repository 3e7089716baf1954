//! The expansion: sample D and G on a tensor grid, transform, differentiate for h.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::Lagrangian;
use super::coefficients::{Entry, Layers, distinct};
use super::function::{Function, MAX_JOINTS};
use super::transform::{Axis, grid_point, grid_size, transform};
use crate::arm::{Arm, JointKind, Uncertainty};
use crate::dynamics::{gravity, mass_matrix};

/// What is below this fraction of the largest coefficient is rounding error of the transform.
pub(super) const NEGLIGIBLE: f64 = 1e-12;

/// A combination by function rather than by index.
pub type Expansion = BTreeMap<Function, f64>;

/// Expands the exact model (1) of `arm` over the harmonic dictionary.
///
/// In each revolute joint d_ij is a trigonometric polynomial of degree ≤ 2 and g_i of degree ≤ 1, in each
/// prismatic joint both are polynomials of degree ≤ 2, so sampling and inverting the transform is exact
/// to rounding. h_ijk = ½(∂d_ij/∂q_k + ∂d_ik/∂q_j − ∂d_jk/∂q_i).
pub fn expand(arm: &Arm) -> Lagrangian {
    expand_family(arm, &Uncertainty::default())
}

/// The same for a family of arms: the model is linear in the inertial parameters, so its derivative by each uncertain
/// one is the model of an arm that has that parameter alone.
pub fn expand_family(arm: &Arm, uncertainty: &Uncertainty) -> Lagrangian {
    let mut layers = vec![entries(arm)];
    layers.extend((0..uncertainty.parameters.len()).map(|k| entries(&uncertainty.alone(arm, k))));
    let truncation = layers.iter().map(|(_, truncation)| *truncation).collect();
    let mut columns: Vec<_> = layers.into_iter().map(|(entries, _)| entries.into_iter()).collect();
    let joined = Entry::all(arm.dof())
        .map(|entry| Layers { entry, layers: columns.iter_mut().filter_map(Iterator::next).collect() })
        .collect();
    let ranges = uncertainty.parameters.iter().map(|p| [p.low, p.high]).collect();
    Lagrangian { ranges, ..distinct(arm.dof(), joined, truncation) }
}

/// d_ij with i ≤ j, h_ijk with j ≤ k and g_i, and the most that one of them lost.
fn entries(arm: &Arm) -> (Vec<Expansion>, f64) {
    let n = arm.dof();
    let (d, dropped_d) = expand_mass_matrix(arm);
    let (g, dropped_g) = expand_gravity(arm);
    // h is half the sum of three derivatives, each at most twice what it is taken of.
    let mut truncation = dropped_g.max(3.0 * dropped_d);
    let largest_d = largest(d.iter().flatten());
    let mut entries = Vec::new();
    for entry in Entry::all(n) {
        entries.push(match entry {
            Entry::D(i, j) => d[i][j].clone(),
            Entry::H(i, j, k) => {
                let (h, dropped) = christoffel(&d, i, j, k, NEGLIGIBLE * largest_d);
                truncation = truncation.max(3.0 * dropped_d + dropped);
                h
            }
            Entry::G(i) => g[i].clone(),
        });
    }
    (entries, truncation)
}

/// D, and the most that an entry lost.
fn expand_mass_matrix(arm: &Arm) -> (Vec<Vec<Expansion>>, f64) {
    let n = arm.dof();
    // D does not depend on the first joint.
    let axes: Vec<Axis> = arm
        .joints
        .iter()
        .enumerate()
        .map(|(j, joint)| if j == 0 { Axis::constant() } else { Axis::new(joint.kind, 2) })
        .collect();
    let samples = sample(&axes, |q| mass_matrix(arm, q).concat());
    let columns: Vec<Vec<_>> = (0..n * n)
        .into_par_iter()
        .map(|entry| {
            if entry / n > entry % n {
                return Vec::new();
            }
            let column: Vec<f64> = samples.iter().map(|sample| sample[entry]).collect();
            collect(arm, &axes, &column)
        })
        .collect();
    let scale = columns.iter().flatten().map(|(_, k)| k.abs()).fold(0.0, f64::max);
    let (upper, dropped) = significant(columns, NEGLIGIBLE * scale);
    let full = (0..n).map(|i| (0..n).map(|j| upper[i.min(j) * n + i.max(j)].clone()).collect()).collect();
    (full, dropped)
}

/// G, and the most that an entry lost.
fn expand_gravity(arm: &Arm) -> (Vec<Expansion>, f64) {
    let axes: Vec<Axis> = arm.joints.iter().map(|joint| Axis::new(joint.kind, 1)).collect();
    let samples = sample(&axes, |q| gravity(arm, q));
    let columns: Vec<Vec<_>> = (0..arm.dof())
        .map(|i| collect(arm, &axes, &samples.iter().map(|sample| sample[i]).collect::<Vec<_>>()))
        .collect();
    let scale = columns.iter().flatten().map(|(_, k)| k.abs()).fold(0.0, f64::max);
    significant(columns, NEGLIGIBLE * scale)
}

/// Values of `f` on the grid, in grid order.
fn sample(axes: &[Axis], f: impl Fn(&[f64]) -> Vec<f64> + Sync) -> Vec<Vec<f64>> {
    (0..grid_size(axes))
        .into_par_iter()
        .map(|index| {
            let point = grid_point(axes, index);
            let q: Vec<f64> = axes.iter().zip(point).map(|(axis, k)| axis.nodes[k]).collect();
            f(&q)
        })
        .collect()
}

/// The real canonical terms of a transformed sample array.
fn collect(arm: &Arm, axes: &[Axis], samples: &[f64]) -> Vec<(Function, f64)> {
    let mut terms = Vec::new();
    for (index, (re, im)) in transform(axes, samples).into_iter().enumerate() {
        let mut kappa = [0; MAX_JOINTS];
        let mut power = [0; MAX_JOINTS];
        for (j, (axis, k)) in axes.iter().zip(grid_point(axes, index)).enumerate() {
            match arm.joints[j].kind {
                JointKind::Revolute => kappa[j] = axis.index[k],
                JointKind::Prismatic => power[j] = axis.index[k].unsigned_abs(),
            }
        }
        // c e^{iκq} and its conjugate partner at −κ together make 2 Re c cos(κq) − 2 Im c sin(κq).
        match kappa.iter().find(|&&k| k != 0) {
            None => terms.push((Function { kappa, power, sine: false }, re)),
            Some(&first) if first > 0 => {
                terms.push((Function { kappa, power, sine: false }, 2.0 * re));
                terms.push((Function { kappa, power, sine: true }, -2.0 * im));
            }
            Some(_) => {}
        }
    }
    terms
}

/// The terms above `threshold`, and the largest sum of magnitudes that one column lost.
fn significant(columns: Vec<Vec<(Function, f64)>>, threshold: f64) -> (Vec<Expansion>, f64) {
    let lost = |column: &Vec<(Function, f64)>| -> f64 {
        column.iter().map(|(_, k)| k.abs()).filter(|&k| k <= threshold).sum()
    };
    let dropped = columns.iter().map(lost).fold(0.0, f64::max);
    let keep =
        |column: Vec<(Function, f64)>| column.into_iter().filter(|(_, k)| k.abs() > threshold).collect();
    (columns.into_iter().map(keep).collect(), dropped)
}

fn largest<'a>(expansions: impl Iterator<Item = &'a Expansion>) -> f64 {
    expansions.flat_map(|e| e.values()).fold(0.0, |sofar, k| k.abs().max(sofar))
}

/// h_ijk by exact differentiation; cancellations below `threshold` are dropped, and their magnitudes summed.
fn christoffel(d: &[Vec<Expansion>], i: usize, j: usize, k: usize, threshold: f64) -> (Expansion, f64) {
    let mut sum = Expansion::new();
    for (expansion, joint, factor) in [(&d[i][j], k, 0.5), (&d[i][k], j, 0.5), (&d[j][k], i, -0.5)] {
        for (function, value) in expansion {
            if let Some((derivative, slope)) = function.derivative(joint) {
                *sum.entry(derivative).or_insert(0.0) += factor * slope * value;
            }
        }
    }
    let dropped = sum.values().map(|value| value.abs()).filter(|&value| value <= threshold).sum();
    sum.retain(|_, value| value.abs() > threshold);
    (sum, dropped)
}
