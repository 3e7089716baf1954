//! Whether D(q) is positive definite over the joint limits, by sampling.

use nalgebra::DMatrix;

use super::{Arm, Parameter, Uncertainty};
use crate::error::Diagnostics;
use crate::numerics::low_discrepancy::{LowDiscrepancy, corner, in_box};

/// Samples inside the box, beside its corners.
const SAMPLES: usize = 512;

/// The smallest eigenvalue of D, with rows and columns scaled so that its diagonal is 1, must exceed this: metres beside
/// radians, and a long rail beside a wrist, are no reason to doubt an arm.
const LEAST: f64 = 1e-9;

/// A diagonal entry below this part of the largest one, where that is smallest, is rounding.
const NOTHING: f64 = 1e-12;

/// A state in which D(q) is not safely positive definite.
#[derive(Clone, Debug, PartialEq)]
pub struct Indefinite {
    /// The state, rad or m.
    pub q: Vec<f64>,
    /// Smallest eigenvalue of D(q), kg·m² (NaN where D is not finite).
    pub eigenvalue: f64,
    /// Largest diagonal entry of D(q), kg·m².
    pub scale: f64,
    /// The joint that moves least there, from 0.
    pub joint: usize,
}

impl Indefinite {
    /// Adds this as a fault of the field `arm`.
    pub fn report(&self, arm: &Arm, faults: &mut Diagnostics) {
        let name = arm.joints.get(self.joint).map_or("", |joint| joint.name.as_str());
        faults.push(
            "arm",
            format!(
                "has the inertia matrix D(q) with the smallest eigenvalue {:.3e} (largest entry {:.3e} kg·m²) at q = {:?}: \
                 the joint {name} moves almost no mass there",
                self.eigenvalue, self.scale, self.q
            ),
            format!("give every joint some inertia: check the masses behind {name}, or add `armature` to it"),
        );
    }

    /// Adds this as a fault of the field `control.uncertainty`, for the arm with its parameters at `u`.
    pub fn report_member(&self, uncertainty: &Uncertainty, u: &[f64], faults: &mut Diagnostics) {
        let at = |(p, u): (&Parameter, &f64)| format!("{} = {:.6}", p.name, p.nominal + u);
        let values: Vec<String> = uncertainty.parameters.iter().zip(u).map(at).collect();
        faults.push(
            "control.uncertainty",
            format!(
                "admits an arm that cannot exist: with {} the inertia matrix D(q) has the smallest eigenvalue {:.3e} at q = {:?}",
                values.join(", "),
                self.eigenvalue,
                self.q
            ),
            "narrow the intervals, so that every combination of their ends is the inertia of a body",
        );
    }
}

/// The first state, among the corners of the joint limits and a fixed low-discrepancy sequence inside them, at which
/// `mass_matrix` (n×n, by rows) is not safely positive definite, as [`indefinite_among`] judges it.
///
/// Where limits are unknown the box is [−π, π] rad or [−1, 1] m. A sample, not a proof.
pub fn indefinite(arm: &Arm, mass_matrix: impl Fn(&[f64]) -> Vec<Vec<f64>>) -> Option<Indefinite> {
    let limits = arm.joint_box();
    let n = limits.len();
    let spread = LowDiscrepancy::new(n);
    let units =
        (0..SAMPLES).map(|index| spread.point(index)).chain((0..1 << n).map(|index| corner(index, n)));
    let positions: Vec<Vec<f64>> = units.map(|unit| in_box(&limits, &unit)).collect();
    indefinite_among(&positions, mass_matrix)
}

/// The first of `positions` at which `mass_matrix` is not safely positive definite: it holds a number that is not finite,
/// moves a joint with no more inertia than rounding, fails the Cholesky factorisation, or has an eigenvalue of at most
/// 1e-9 once its diagonal is scaled to 1.
pub fn indefinite_among<'a>(
    positions: impl IntoIterator<Item = &'a Vec<f64>>,
    mass_matrix: impl Fn(&[f64]) -> Vec<Vec<f64>>,
) -> Option<Indefinite> {
    let matrices: Vec<(&Vec<f64>, DMatrix<f64>)> =
        positions.into_iter().map(|q| (q, dense(&mass_matrix(q)))).collect();
    let largest = |d: &DMatrix<f64>| d.diagonal().iter().copied().fold(0.0, f64::max);
    let scale = matrices.iter().map(|(_, d)| largest(d)).fold(f64::INFINITY, f64::min);
    matrices.iter().find_map(|(q, d)| judge(d, q, NOTHING * scale, largest(d)))
}

fn dense(d: &[Vec<f64>]) -> DMatrix<f64> {
    let n = d.len();
    DMatrix::from_fn(n, n, |i, j| d.get(i).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN))
}

/// `floor` is what a diagonal entry must exceed.
fn judge(matrix: &DMatrix<f64>, q: &[f64], floor: f64, scale: f64) -> Option<Indefinite> {
    let n = matrix.nrows();
    let diagonal = matrix.diagonal();
    let least = (0..n).min_by(|&i, &j| diagonal[i].total_cmp(&diagonal[j])).unwrap_or(0);
    let found = |eigenvalue: f64, joint: usize| Indefinite { q: q.to_vec(), eigenvalue, scale, joint };
    // The eigenvalue iteration need not end on NaN.
    if !matrix.iter().all(|v| v.is_finite()) {
        return Some(found(f64::NAN, least));
    }
    if (0..n).any(|i| diagonal[i] <= floor) {
        return Some(found(matrix.symmetric_eigenvalues().min(), least));
    }
    let roots: Vec<f64> = diagonal.iter().map(|&d| libm::sqrt(d)).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / roots[i] / roots[j]);
    let whole = scaled.clone().symmetric_eigen();
    let lowest = (0..n).min_by(|&i, &j| whole.eigenvalues[i].total_cmp(&whole.eigenvalues[j])).unwrap_or(0);
    let definite = scaled.cholesky().is_some() && whole.eigenvalues[lowest] > LEAST;
    if definite {
        return None;
    }
    let part = |i: usize| whole.eigenvectors[(i, lowest)].abs();
    // Where several take part alike, the last one: it carries least.
    let joint = (0..n).max_by(|&i, &j| part(i).total_cmp(&part(j))).unwrap_or(least);
    Some(found(matrix.symmetric_eigenvalues().min(), joint))
}

#[cfg(test)]
mod tests {
    use super::super::{Body, Joint, JointKind, Limits, Transform};
    use super::*;

    fn arm() -> Arm {
        let joint = Joint {
            name: "j".into(),
            kind: JointKind::Revolute,
            pose: Transform::IDENTITY,
            body: Body::default(),
            link: Transform::IDENTITY,
            armature: 0.0,
            viscous_friction: 0.0,
            coulomb_friction: [0.0; 2],
            limits: Limits { position: Some([-1.0, 2.0]), ..Limits::default() },
        };
        Arm { gravity: [0.0; 3], joints: vec![joint.clone(), joint], tip: Transform::IDENTITY, linkage: None }
    }

    #[test]
    fn finds_the_corner_at_which_the_matrix_is_singular() {
        let at_corner = |q: &[f64]| vec![vec![1.0, 0.0], vec![0.0, 4.0 - q[0] - q[1]]];
        let found = indefinite(&arm(), at_corner).expect("the corner (2, 2) is singular");
        assert_eq!(found.q, [2.0, 2.0]);
        assert_eq!(found.scale, 1.0);
        assert!(indefinite(&arm(), |q| vec![vec![1.0, 0.0], vec![0.0, 4.1 - q[0] - q[1]]]).is_none());
    }

    #[test]
    fn not_finite_matrices_end_in_a_fault() {
        let found = indefinite(&arm(), |_| vec![vec![f64::NAN, 0.0], vec![0.0, 1.0]]).expect("NaN");
        let mut faults = Diagnostics::of(std::path::Path::new("a.json"));
        found.report(&arm(), &mut faults);
        assert!(faults.into_error().to_string().starts_with("a.json: arm: has the inertia matrix"));
    }
}
