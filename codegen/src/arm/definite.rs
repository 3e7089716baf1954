//! Whether D(q) is positive definite over the joint limits, by sampling.

use nalgebra::DMatrix;

use super::{Arm, Parameter, Uncertainty};
use crate::error::Faults;
use crate::spread::{Spread, corner, in_box};

/// Samples inside the box, beside its corners.
const SAMPLES: usize = 512;

/// λ_min(D) must exceed this part of the largest diagonal entry.
const LEAST: f64 = 1e-9;

/// A state in which D(q) is not safely positive definite.
#[derive(Clone, Debug, PartialEq)]
pub struct Indefinite {
    /// The state, rad or m.
    pub q: Vec<f64>,
    /// Smallest eigenvalue of D(q), kg·m² (NaN where D is not finite).
    pub eigenvalue: f64,
    /// Largest diagonal entry of D(q), kg·m².
    pub scale: f64,
}

impl Indefinite {
    /// Adds this as a fault of the field `arm`.
    pub fn report(&self, faults: &mut Faults) {
        faults.push(
            "arm",
            format!(
                "has the inertia matrix D(q) with the smallest eigenvalue {:.3e} (largest entry {:.3e} kg·m²) at q = {:?}",
                self.eigenvalue, self.scale, self.q
            ),
            "give every joint some inertia: check the masses, or add `armature` to joints that move no mass",
        );
    }

    /// Adds this as a fault of the field `control.uncertainty`, for the arm with its parameters at `u`.
    pub fn report_member(&self, uncertainty: &Uncertainty, u: &[f64], faults: &mut Faults) {
        let at = |(p, u): (&Parameter, &f64)| format!("{} = {:.6}", p.name, p.nominal + u);
        let values: Vec<String> = uncertainty.parameters.iter().zip(u).map(at).collect();
        faults.push(
            "control.uncertainty",
            format!(
                "reaches an arm that cannot be: with {} the inertia matrix D(q) has the smallest eigenvalue {:.3e} at q = {:?}",
                values.join(", "),
                self.eigenvalue,
                self.q
            ),
            "narrow the intervals, so that every combination of their ends is the inertia of a body",
        );
    }
}

/// The first state, among the corners of the joint limits and a fixed low-discrepancy sequence inside them, at which
/// `mass_matrix` (n×n, by rows) fails the Cholesky factorisation or has λ_min ≤ 1e-9 of its largest diagonal entry.
///
/// Where limits are unknown the box is [−π, π] rad or [−1, 1] m. A sample, not a proof.
pub fn indefinite(arm: &Arm, mass_matrix: impl Fn(&[f64]) -> Vec<Vec<f64>>) -> Option<Indefinite> {
    let limits = arm.joint_box();
    let n = limits.len();
    let spread = Spread::new(n);
    let units =
        (0..SAMPLES).map(|index| spread.point(index)).chain((0..1 << n).map(|index| corner(index, n)));
    units.map(|unit| in_box(&limits, &unit)).find_map(|q| judge(&mass_matrix(&q), q))
}

/// The first of `positions` at which `mass_matrix` fails as in [`indefinite`].
pub fn indefinite_among<'a>(
    positions: impl IntoIterator<Item = &'a Vec<f64>>,
    mass_matrix: impl Fn(&[f64]) -> Vec<Vec<f64>>,
) -> Option<Indefinite> {
    positions.into_iter().find_map(|q| judge(&mass_matrix(q), q.clone()))
}

fn judge(d: &[Vec<f64>], q: Vec<f64>) -> Option<Indefinite> {
    let n = d.len();
    let entry = |i: usize, j: usize| d.get(i).and_then(|row| row.get(j)).copied().unwrap_or(f64::NAN);
    let matrix = DMatrix::from_fn(n, n, entry);
    let scale = (0..n).map(|i| entry(i, i)).fold(0.0, f64::max);
    // The eigenvalue iteration need not end on NaN.
    if !matrix.iter().all(|v| v.is_finite()) {
        return Some(Indefinite { q, eigenvalue: f64::NAN, scale });
    }
    let eigenvalue = matrix.symmetric_eigenvalues().iter().copied().fold(f64::INFINITY, f64::min);
    let definite = matrix.cholesky().is_some() && eigenvalue > LEAST * scale;
    (!definite).then_some(Indefinite { q, eigenvalue, scale })
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
        Arm { gravity: [0.0; 3], joints: vec![joint.clone(), joint], tip: Transform::IDENTITY }
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
        let mut faults = Faults::of(std::path::Path::new("a.json"));
        found.report(&mut faults);
        assert!(faults.into_error().to_string().starts_with("a.json: arm: has the inertia matrix"));
    }
}
