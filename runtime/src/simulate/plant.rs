//! The arm that is simulated.

use core::array::from_fn;

use crate::cholesky::Cholesky;
use crate::law::coulomb_torque;
use crate::vector::first_not_finite;
use crate::{Model, PlantError, Real};

/// Anything with `N` joints that answers torque with acceleration.
pub trait Plant<T: Real, const N: usize> {
    /// q̈, rad/s² or m/s², at position q, rad or m, and velocity q̇, rad/s or m/s, under the torque τ, N·m.
    ///
    /// # Errors
    /// When the plant has no acceleration there.
    fn acceleration(&self, q: &[T; N], qd: &[T; N], torque: &[T; N]) -> Result<[T; N], PlantError>;
}

impl<T: Real, P: Plant<T, N> + ?Sized, const N: usize> Plant<T, N> for &P {
    fn acceleration(&self, q: &[T; N], qd: &[T; N], torque: &[T; N]) -> Result<[T; N], PlantError> {
        (**self).acceleration(q, qd, torque)
    }
}

/// Equation (1) of a model solved for the acceleration, with Coulomb friction F: D q̈ = τ − C q̇ − B q̇ − G − F.
///
/// N + 2 model calls and a Cholesky solve. F_i is the level of the direction of q̇_i; at q̇_i = 0 it is whatever
/// balances the rest of the right side of that joint, up to the levels. The friction is not smoothed: near rest a
/// Runge–Kutta step crosses the jump and its error there is of first order in the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPlant<M: Model<N>, const N: usize> {
    /// The arm; its bounds are not used.
    pub model: M,
    /// Coulomb friction of each joint, [forwards ≥ 0, backwards ≤ 0], N·m.
    pub coulomb: [[M::Scalar; 2]; N],
}

impl<M: Model<N>, const N: usize> Plant<M::Scalar, N> for RigidPlant<M, N> {
    fn acceleration(
        &self,
        q: &[M::Scalar; N],
        qd: &[M::Scalar; N],
        torque: &[M::Scalar; N],
    ) -> Result<[M::Scalar; N], PlantError> {
        let bias = self.model.dynamics_bias(q, qd);
        let viscous = self.model.viscous_friction();
        let net = from_fn(|i| {
            let driving = torque[i] - bias[i] - viscous[i] * qd[i];
            driving - friction(&self.coulomb[i], qd[i], driving)
        });
        let mass_matrix = self.model.mass_matrix(q);
        let Some(inertia) = Cholesky::new(&mass_matrix) else {
            // An overflowed position gives NaN here, which is no fault of the model.
            let finite = mass_matrix.iter().all(|row| first_not_finite(row).is_none());
            return Err(if finite { PlantError::MassMatrix } else { PlantError::Diverged });
        };
        Ok(inertia.solve(&net))
    }
}

/// Coulomb friction of one joint, N·m; at rest it sticks.
fn friction<T: Real>(levels: &[T; 2], velocity: T, driving: T) -> T {
    if velocity != T::ZERO {
        return coulomb_torque(levels, velocity);
    }
    let [forward, backward] = *levels;
    if driving > forward {
        forward
    } else if driving < backward {
        backward
    } else {
        driving
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_arm::TwoLink;

    #[test]
    fn solves_equation_1() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let plant = RigidPlant { model: &arm, coulomb: [[0.0; 2]; 2] };
        let (q, qd, qdd) = ([0.4, -1.3], [1.5, 0.6], [2.0, -3.0]);
        let solved = plant.acceleration(&q, &qd, &arm.inverse_dynamics(&q, &qd, &qdd)).unwrap();
        assert!((solved[0] - qdd[0]).abs() < 1e-12 && (solved[1] - qdd[1]).abs() < 1e-12, "{solved:?}");
    }

    #[test]
    fn coulomb_friction_opposes_motion_and_sticks_at_rest() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let plant = RigidPlant { model: arm, coulomb: [[2.0, -3.0], [0.5, -0.5]] };
        let (q, moving, qdd) = ([0.4, -1.3], [1.0, -1.0], [2.0, -3.0]);
        let mut torque = arm.inverse_dynamics(&q, &moving, &qdd);
        torque[0] += 2.0;
        torque[1] -= 0.5;
        let solved = plant.acceleration(&q, &moving, &torque).unwrap();
        assert!((solved[0] - qdd[0]).abs() < 1e-12 && (solved[1] - qdd[1]).abs() < 1e-12, "{solved:?}");

        let [g0, g1] = arm.gravity(&q);
        assert_eq!(plant.acceleration(&q, &[0.0; 2], &[g0 + 1.9, g1 - 0.4]), Ok([0.0; 2]));
        assert_eq!(plant.acceleration(&q, &[0.0; 2], &[g0 - 2.9, g1 + 0.4]), Ok([0.0; 2]));
        let slipping = plant.acceleration(&q, &[0.0; 2], &[g0 + 2.1, g1]).unwrap();
        assert!(slipping[0] > 0.0);
    }

    #[test]
    fn an_impossible_mass_matrix_is_an_error() {
        let arm = TwoLink { inertia: [1.0, 2.0, 0.1], ..TwoLink::<f64>::EXAMPLE };
        let plant = RigidPlant { model: arm, coulomb: [[0.0; 2]; 2] };
        assert_eq!(plant.acceleration(&[0.0; 2], &[0.0; 2], &[0.0; 2]), Err(PlantError::MassMatrix));
    }
}
