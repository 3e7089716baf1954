//! The arm that is simulated.

use core::array::from_fn;

use crate::cholesky::Cholesky;
use crate::law::coulomb_torque;
use crate::step::clamp;
use crate::vector::{along, first_not_finite, sub, unit};
use crate::{Model, PlantError, Real};

/// Anything with `N` joints that answers torque with acceleration.
pub trait Plant<T: Real, const N: usize> {
    /// q̈, rad/s² or m/s², at position q, rad or m, and velocity q̇, rad/s or m/s, under the torque τ, N·m.
    ///
    /// # Errors
    /// When the plant has no acceleration there.
    fn acceleration(&self, q: &[T; N], qd: &[T; N], torque: &[T; N]) -> Result<[T; N], PlantError>;

    /// The velocity after a short step, rad/s or m/s, where the integrator goes from `before` to `after`: 0 for a joint that dry
    /// friction has brought to rest on the way.
    fn stopped(&self, _before: &[T; N], after: [T; N]) -> [T; N] {
        after
    }
}

impl<T: Real, P: Plant<T, N> + ?Sized, const N: usize> Plant<T, N> for &P {
    fn acceleration(&self, q: &[T; N], qd: &[T; N], torque: &[T; N]) -> Result<[T; N], PlantError> {
        (**self).acceleration(q, qd, torque)
    }

    fn stopped(&self, before: &[T; N], after: [T; N]) -> [T; N] {
        (**self).stopped(before, after)
    }
}

/// Equation (1) of a model solved for the acceleration, with Coulomb friction F: D q̈ = τ − C q̇ − B q̇ − G − F.
///
/// N + 2 model calls and a Cholesky solve. F_i is the level of the direction of q̇_i. At q̇_i = 0 the joint sticks: F_i is what keeps
/// its acceleration 0, the pull of the other joints included, up to the levels. The friction is not smoothed: a joint whose
/// velocity changes its sign within a step is at rest after it, and leaves that rest only where more than the levels pulls at it.
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
        let driving: [M::Scalar; N] = from_fn(|i| torque[i] - bias[i] - viscous[i] * qd[i]);
        let force: [M::Scalar; N] = from_fn(|i| friction(&self.coulomb[i], qd[i], driving[i]));
        let mass_matrix = self.model.mass_matrix(q);
        let Some(inertia) = Cholesky::new(&mass_matrix) else {
            // An overflowed position gives NaN here, which is no fault of the model.
            let finite = mass_matrix.iter().all(|row| first_not_finite(row).is_none());
            return Err(if finite { PlantError::MassMatrix } else { PlantError::Diverged });
        };
        let acceleration = inertia.solve(&sub(&driving, &force));
        let sticks: [bool; N] = from_fn(|i| qd[i] == M::Scalar::ZERO && dry(&self.coulomb[i]));
        if !sticks.contains(&true) {
            return Ok(acceleration);
        }
        Ok(self.at_rest(&inertia, &sticks, force, acceleration))
    }

    fn stopped(&self, before: &[M::Scalar; N], after: [M::Scalar; N]) -> [M::Scalar; N] {
        let zero = M::Scalar::ZERO;
        let crosses =
            |i: usize| (before[i] > zero && after[i] < zero) || (before[i] < zero && after[i] > zero);
        from_fn(|i| if crosses(i) && dry(&self.coulomb[i]) { zero } else { after[i] })
    }
}

impl<M: Model<N>, const N: usize> RigidPlant<M, N> {
    /// `acceleration` under the friction `force`, after the friction of the joints that stick has taken it to 0 as far as its levels
    /// allow: Gauss–Seidel over these joints.
    fn at_rest(
        &self,
        inertia: &Cholesky<M::Scalar, N>,
        sticks: &[bool; N],
        mut force: [M::Scalar; N],
        mut acceleration: [M::Scalar; N],
    ) -> [M::Scalar; N] {
        let mobility: [[M::Scalar; N]; N] = from_fn(|i| inertia.solve(&unit(i)));
        for _ in 0..SWEEPS {
            for i in 0..N {
                if !sticks[i] {
                    continue;
                }
                let [forward, backward] = self.coulomb[i];
                let wanted = clamp(force[i] + acceleration[i] / mobility[i][i], backward, forward);
                let change = wanted - force[i];
                force[i] = wanted;
                acceleration = along(&acceleration, -change, &mobility[i]);
            }
        }
        // What the sweeps leave of a joint that is held would make it creep.
        let held = |i: usize| sticks[i] && self.coulomb[i][1] < force[i] && force[i] < self.coulomb[i][0];
        from_fn(|i| if held(i) { M::Scalar::ZERO } else { acceleration[i] })
    }
}

/// Sweeps over the joints that stick.
const SWEEPS: usize = 40;

/// Whether a joint has Coulomb friction.
fn dry<T: Real>(levels: &[T; 2]) -> bool {
    *levels != [T::ZERO; 2]
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
    fn a_joint_at_rest_stays_there_while_another_pulls_at_it() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let plant = RigidPlant { model: arm, coulomb: [[0.0; 2], [4.0, -4.0]] };
        let q = [0.4, -1.3];
        // The friction that the second joint needs, from its row of D q̈ + G = τ − F with q̈ = (a, 0).
        let [g0, g1] = arm.gravity(&q);
        let d = arm.mass_matrix(&q);
        for push in [3.0, -3.0] {
            let solved = plant.acceleration(&q, &[0.0; 2], &[g0 + push, g1]).unwrap();
            assert!((solved[0] - push / d[0][0]).abs() < 1e-12, "{solved:?}");
            assert!((d[1][0] * solved[0]).abs() < 4.0 && solved[1] == 0.0, "{solved:?}");
        }
    }

    /// The law of Coulomb: within its levels the friction holds, and what moves has all of it against it.
    #[test]
    fn friction_at_rest_holds_or_is_at_its_level_against_the_motion() {
        let arm = TwoLink::<f64>::EXAMPLE;
        let levels = [[2.0, -3.0], [1.0, -0.5]];
        let plant = RigidPlant { model: arm, coulomb: levels };
        let mut seen = [0; 4];
        for (i, j) in (0..41).flat_map(|i| (0..41).map(move |j| (i, j))) {
            let q = [0.4, 0.1 * f64::from(i) - 2.0];
            let gravity = arm.gravity(&q);
            let torque = [gravity[0] + 0.4 * f64::from(i) - 8.0, gravity[1] + 0.2 * f64::from(j) - 4.0];
            let solved = plant.acceleration(&q, &[0.0; 2], &torque).unwrap();
            let d = arm.mass_matrix(&q);
            for (k, [forward, backward]) in levels.into_iter().enumerate() {
                let force = torque[k] - gravity[k] - d[k][0] * solved[0] - d[k][1] * solved[1];
                let wanted = match solved[k] {
                    a if a > 0.0 => [forward; 2],
                    a if a < 0.0 => [backward; 2],
                    _ => [backward, forward],
                };
                let inside = wanted[0] - 1e-9 <= force && force <= wanted[1] + 1e-9;
                assert!(inside, "{torque:?}: {solved:?}, friction {force} of joint {k}");
                seen[2 * k + usize::from(solved[k] == 0.0)] += 1;
            }
        }
        assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
    }

    #[test]
    fn an_impossible_mass_matrix_is_an_error() {
        let arm = TwoLink { inertia: [1.0, 2.0, 0.1], ..TwoLink::<f64>::EXAMPLE };
        let plant = RigidPlant { model: arm, coulomb: [[0.0; 2]; 2] };
        assert_eq!(plant.acceleration(&[0.0; 2], &[0.0; 2], &[0.0; 2]), Err(PlantError::MassMatrix));
    }
}
